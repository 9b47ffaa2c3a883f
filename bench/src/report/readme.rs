//! What the READMEs show: a table of four rows, and a chart for light and one for dark pages.

use std::fmt::Write;
use std::path::Path;

use anyhow::{Context, Result, anyhow, ensure};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::cases::{advantage, find, is_open};
use super::format::{count, significant, time};
use crate::libraries::THIS_CRATE;
use crate::record::{Case, Record};

/// The table stands between these lines, and nothing else does.
const START: &str = "<!-- benchmark: written by bench/report, do not edit -->";
const END: &str = "<!-- benchmark ends -->";

/// The scene of the chart and of the table's times, and its dimensions.
const SCENE: (&str, usize) = ("uniform", 3);

/// The alternatives that the chart shows, with the names that most readers know them by.
const SHOWN: [(&str, &str); 6] = [
    ("plain sweep", "hand-written sweep"),
    ("parry", "parry (BVH)"),
    ("Boost.Geometry", "Boost.Geometry (R-tree)"),
    ("packed_spatial_index", "packed_spatial_index"),
    ("PhysX ABP", "PhysX (ABP)"),
    (THIS_CRATE, "sweep-and-prune"),
];

const SIZE: (u32, u32) = (860, 430);
/// Where the names of the lines stand.
const NAMES: u32 = 200;

/// What a page's background asks for.
struct Theme {
    file: &'static str,
    text: RGBColor,
    grid: RGBColor,
    main: RGBColor,
    lines: [RGBColor; 5],
}

const THEMES: [Theme; 2] = [
    Theme {
        file: "benchmark.svg",
        text: RGBColor(31, 35, 40),
        grid: RGBColor(222, 226, 230),
        main: RGBColor(196, 60, 24),
        lines: [
            RGBColor(110, 75, 170),
            RGBColor(0, 114, 178),
            RGBColor(0, 125, 94),
            RGBColor(150, 100, 0),
            RGBColor(100, 105, 110),
        ],
    },
    Theme {
        file: "benchmark-dark.svg",
        text: RGBColor(230, 237, 243),
        grid: RGBColor(54, 60, 68),
        main: RGBColor(255, 133, 92),
        lines: [
            RGBColor(185, 155, 240),
            RGBColor(86, 180, 233),
            RGBColor(65, 200, 160),
            RGBColor(230, 180, 60),
            RGBColor(165, 172, 180),
        ],
    },
];

/// Replaces the table in each of these READMEs and writes the charts into `docs`.
pub fn write(record: &Record, root: &Path) -> Result<()> {
    for readme in ["README.md", "core/README.md"] {
        let path = root.join(readme);
        let text = std::fs::read_to_string(&path).with_context(|| format!("reading {readme}"))?;
        std::fs::write(
            &path,
            replaced(&text, &table(record)?).with_context(|| readme.to_owned())?,
        )?;
    }
    THEMES.iter().try_for_each(|theme| draw(record, &root.join("docs").join(theme.file), theme))
}

/// A README with this table in place of the one that it holds.
fn replaced(text: &str, table: &str) -> Result<String> {
    let parts = text.split_once(START).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(END)?;
        Some((before, after))
    });
    let (before, after) = parts.context("the lines around the benchmark's table are missing")?;
    Ok(format!("{before}{START}\n{table}\n{END}{after}"))
}

/// Four rows, from a thousand boxes to a million, and what was measured.
fn table(record: &Record) -> Result<String> {
    let mut text = String::from(
        "| boxes | sweep-and-prune | fastest alternative | mean of all scenes | closest scene |\n\
         |--:|--:|---|--:|--:|\n",
    );
    let mut scenes = Vec::new();
    for boxes in [1_000, 10_000, 100_000, 1_000_000] {
        let case = case(record, boxes)?;
        let own = case.times(THIS_CRATE).context("no time of our own")?;
        let ranking = case.ranking();
        let (name, times) = ranking.first().context("no alternative was timed")?;
        let ratios: Vec<f64> = record
            .cases
            .iter()
            .filter(|case| case.boxes == boxes && is_open(case))
            .filter_map(advantage)
            .collect();
        ensure!(!ratios.is_empty(), "no scene of {boxes} boxes was measured");
        let mean = (ratios.iter().map(|ratio| ratio.ln()).sum::<f64>() / ratios.len() as f64).exp();
        let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        scenes.push(ratios.len());
        let _ = writeln!(
            text,
            "| {} | {} | {name}: {} | {} times as long | {} times |",
            count(boxes as u64),
            time(own.median_ns),
            time(times.median_ns),
            significant(mean),
            significant(least),
        );
    }
    let (scene, dimensions) = SCENE;
    let (least, most) = (scenes.iter().min().unwrap_or(&0), scenes.iter().max().unwrap_or(&0));
    let scenes = if least == most { format!("{most}") } else { format!("{least} to {most}") };
    let _ = write!(
        text,
        "\nThe times (lower is better) are those of the scene *{scene} {dimensions}D*; the last two \
         columns say how long the fastest alternative of each scene takes, compared with sweep-and-prune: the \
         geometric mean and the minimum over {scenes} scenes in 2D and 3D. One thread, from raw boxes to stored pairs. {}, {} \
         cores, {}{}.",
        record.machine.cpu,
        record.machine.cores,
        record.date,
        if record.machine.load.is_some_and(|load| load > 0.5) {
            "; other programs were running"
        } else {
            ""
        },
    );
    Ok(text)
}

fn case(record: &Record, boxes: usize) -> Result<&Case> {
    let (scene, dimensions) = SCENE;
    find(record, scene, dimensions, boxes)
        .with_context(|| format!("{scene} {dimensions}D with {boxes} boxes was not measured"))
}

/// Each line's name at its end, so that no legend is needed.
fn draw(record: &Record, path: &Path, theme: &Theme) -> Result<()> {
    let sizes = [1_000usize, 10_000, 100_000, 1_000_000];
    let mut lines = Vec::new();
    for (at, (name, label)) in SHOWN.into_iter().enumerate() {
        let mut points = Vec::new();
        for boxes in sizes {
            if let Some(times) = case(record, boxes)?.times(name) {
                points.push((boxes as f64, times.median_ns / 1e6));
            }
        }
        if !points.is_empty() {
            lines.push((label, points, theme.lines.get(at).copied()));
        }
    }
    let failed = |error| anyhow!("drawing {}: {error}", path.display());
    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    let font = |size: i32, color: &RGBColor| ("sans-serif", size).into_font().color(color);
    let mut chart = ChartBuilder::on(&root)
        .caption("Time to find all pairs, milliseconds (lower is better)", font(19, &theme.text))
        .margin(10)
        .margin_right(NAMES)
        .x_label_area_size(40)
        .y_label_area_size(56)
        .build_cartesian_2d((900.0..1.1e6f64).log_scale(), (0.02..3e3f64).log_scale())
        .map_err(failed)?;
    chart
        .configure_mesh()
        .x_desc("boxes, evenly spread in 3D")
        .x_labels(4)
        .x_label_formatter(&|boxes| count(boxes.round() as u64))
        .y_label_formatter(&|ms| format!("{ms}"))
        .axis_style(theme.grid)
        .bold_line_style(theme.grid)
        .light_line_style(TRANSPARENT)
        .label_style(font(15, &theme.text))
        .draw()
        .map_err(failed)?;
    // Names that would overlap are moved apart, the slowest on top.
    lines.sort_by(|a, b| {
        let end = |points: &[(f64, f64)]| points.last().map_or(0.0, |point| point.1 / point.0);
        end(&b.1).total_cmp(&end(&a.1))
    });
    let (mut column, mut row) = (0, f64::NEG_INFINITY);
    for (label, points, color) in &lines {
        let color = color.unwrap_or(theme.main);
        let style = color.stroke_width(if color == theme.main { 5 } else { 2 });
        let circles = points.iter().map(|&at| Circle::new(at, 3, style.filled()));
        chart.draw_series(circles).map_err(failed)?;
        chart.draw_series(LineSeries::new(points.iter().copied(), style)).map_err(failed)?;
        let &end = points.last().context("a line without points")?;
        let (x, y) = chart.backend_coord(&end);
        row = f64::from(y).max(if x == column { row + 19.0 } else { row.min(0.0) });
        column = x;
        let name = font(if color == theme.main { 19 } else { 15 }, &color)
            .pos(Pos::new(HPos::Left, VPos::Center));
        root.draw(&Text::new((*label).to_owned(), (x + 10, row as i32), name)).map_err(failed)?;
    }
    root.present().map_err(failed)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The figures in the READMEs are those of the results that are kept.
    #[test]
    fn the_tables_of_the_readmes_are_those_of_the_fullest_results() {
        let bench = Path::new(env!("CARGO_MANIFEST_DIR"));
        let newest = super::super::newest(&bench.join("results")).unwrap();
        let table = table(super::super::fullest(&newest).unwrap()).unwrap();
        for readme in ["../README.md", "../core/README.md"] {
            let text = std::fs::read_to_string(bench.join(readme)).unwrap();
            assert_eq!(replaced(&text, &table).unwrap(), text, "{readme}: run bench/report");
        }
    }
}
