//! The plots, in SVG: a scene's times against the number of boxes, and the advantage over the
//! fastest alternative.

use std::path::Path;

use anyhow::{Result, anyhow};
use plotters::prelude::*;

use super::cases::{SMALL, advantage, is_open, names, scenes};
use super::single::each;
use super::table::GOALS;
use crate::libraries::THIS_CRATE;
use crate::record::{Case, Record, Times};

const SIZE: (u32, u32) = (920, 560);
/// The width of the legend.
const LEGEND: u32 = 220;

/// One plot.
struct Plot {
    file: String,
    title: String,
    y_label: &'static str,
    series: Vec<Series>,
}

/// A line of a plot, its points in ascending x.
struct Series {
    name: String,
    points: Vec<(f64, f64)>,
    look: Look,
}

/// How a line is drawn.
#[derive(Clone, Copy)]
enum Look {
    /// The line that the plot is about.
    Main,
    /// In the color of this number, and dashed where the colors are used up.
    Line(usize),
    /// Without a name.
    Faint,
}

/// Writes the plots into the folder and returns their file names.
pub fn write(record: &Record, folder: &Path) -> Result<Vec<String>> {
    let large: Vec<_> = record.cases.iter().filter(|case| case.boxes > SMALL).cloned().collect();
    let (open, others): (Vec<_>, Vec<_>) = large.into_iter().partition(is_open);
    let mut plots = vec![
        Plot {
            file: "advantage.svg".into(),
            title: "How many times slower than sweep-and-prune the fastest alternative is".into(),
            y_label: "fastest alternative / sweep-and-prune",
            series: advantages(&open),
        },
        Plot {
            file: "flat.svg".into(),
            title: "sweep-and-prune on every scene: time for each box and each pair".into(),
            y_label: "nanoseconds",
            series: flatness(&[&open[..], &others].concat()),
        },
    ];
    // Over all cases, so that a library has the same color in every plot.
    let finders = names(&open.iter().collect::<Vec<_>>());
    plots.extend(of_scenes(&open, &finders, "", "time to find all pairs"));
    plots.extend(memory(&open, &finders, "uniform", "find all pairs"));
    let trackers = names(&record.worlds.iter().collect::<Vec<_>>());
    plots.extend(of_scenes(&record.worlds, &trackers, "world-", "time of a frame"));
    plots.extend(memory(&record.worlds, &trackers, "drift", "track pairs"));
    plots.retain(|plot| plot.series.iter().any(|series| !series.points.is_empty()));
    for plot in &plots {
        draw(&folder.join(&plot.file), plot)?;
    }
    Ok(plots.into_iter().map(|plot| plot.file).collect())
}

/// The fastest alternative over sweep-and-prune, of every scene.
fn advantages(cases: &[Case]) -> Vec<Series> {
    let mut series = Vec::new();
    for (scene, dimensions) in scenes(cases) {
        let point = |case: &&Case| Some((case.boxes as f64, advantage(case)?));
        series.push(Series {
            name: format!("{scene} {dimensions}D"),
            points: of(cases, &scene, dimensions).iter().filter_map(point).collect(),
            look: Look::Line(series.len()),
        });
    }
    series.push(Series {
        name: "goal of the mean".into(),
        points: GOALS.map(|(boxes, goal)| (boxes as f64, goal)).to_vec(),
        look: Look::Main,
    });
    series
}

/// This library on every scene: uniform, and the scenes that it is slowest on, stand out.
fn flatness(cases: &[Case]) -> Vec<Series> {
    let mut series: Vec<Series> = scenes(cases)
        .into_iter()
        .map(|(scene, dimensions)| {
            let point = |case: &&Case| Some((case.boxes as f64, each(case)?));
            Series {
                name: format!("{scene} {dimensions}D"),
                points: of(cases, &scene, dimensions).iter().filter_map(point).collect(),
                look: if scene == "uniform" { Look::Main } else { Look::Faint },
            }
        })
        .collect();
    let slowest = |series: &Series| series.points.iter().map(|it| it.1).fold(0.0, f64::max);
    series.sort_by(|a, b| slowest(b).total_cmp(&slowest(a)));
    let faint = series.iter_mut().filter(|series| matches!(series.look, Look::Faint));
    for (at, series) in faint.take(8).enumerate() {
        series.look = Look::Line(at);
    }
    series.retain(|series| !series.points.is_empty());
    series
}

/// A plot a scene: each library's time against the number of boxes.
fn of_scenes(cases: &[Case], libraries: &[String], prefix: &str, what: &str) -> Vec<Plot> {
    let plot = |(scene, dimensions): (String, usize)| {
        let file = format!("{prefix}{}-{dimensions}d.svg", scene.replace(['/', '.'], "-"));
        let milliseconds = |times: &Times| Some(times.median_ns / 1e6);
        Plot {
            file,
            title: format!("{scene} {dimensions}D: {what}"),
            y_label: "milliseconds",
            series: lines(&of(cases, &scene, dimensions), libraries, milliseconds),
        }
    };
    scenes(cases).into_iter().map(plot).collect()
}

/// Each library's memory a box against the number of boxes, in two dimensions and in three.
fn memory(cases: &[Case], libraries: &[String], scene: &str, what: &str) -> Vec<Plot> {
    let plot = |dimensions: usize| {
        let of = of(cases, scene, dimensions);
        let mut series = lines(&of, libraries, |times| Some(times.peak_bytes? as f64));
        for (boxes, bytes) in series.iter_mut().flat_map(|series| &mut series.points) {
            *bytes /= *boxes;
        }
        // What is less than a page cannot be measured.
        series.iter_mut().for_each(|series| series.points.retain(|it| it.0 * it.1 > 65536.0));
        Plot {
            file: format!("memory-{scene}-{dimensions}d.svg"),
            title: format!("{scene} {dimensions}D: most memory in use to {what}, beyond the boxes"),
            y_label: "bytes a box",
            series,
        }
    };
    [2, 3].map(plot).into()
}

/// The cases of a scene, few boxes first.
fn of<'a>(cases: &'a [Case], scene: &str, dimensions: usize) -> Vec<&'a Case> {
    let wanted = |case: &&Case| case.scene == scene && case.dimensions == dimensions;
    let mut cases: Vec<_> = cases.iter().filter(wanted).collect();
    cases.sort_by_key(|case| case.boxes);
    cases
}

/// A line a library.
fn lines(
    cases: &[&Case],
    libraries: &[String],
    value: impl Fn(&Times) -> Option<f64>,
) -> Vec<Series> {
    let series = |(at, name): (usize, &String)| {
        let point = |case: &&Case| Some((case.boxes as f64, value(case.times(name)?)?));
        Series {
            name: name.clone(),
            points: cases.iter().filter_map(point).collect(),
            look: if name == THIS_CRATE { Look::Main } else { Look::Line(at) },
        }
    };
    libraries.iter().enumerate().map(series).collect()
}

/// A log-log plot with the legend outside on the right, in the order in which the lines end.
fn draw(path: &Path, plot: &Plot) -> Result<()> {
    let mut series: Vec<_> =
        plot.series.iter().filter(|series| !series.points.is_empty()).collect();
    series.sort_by(|a, b| {
        let end = |series: &Series| series.points.last().copied().unwrap_or_default();
        let (a, b) = (end(a), end(b));
        b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1))
    });
    let points = || series.iter().flat_map(|series| &series.points);
    let x = range(points().map(|point| point.0));
    let y = range(points().map(|point| point.1));
    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    let failed = |error| anyhow!("drawing {}: {error}", path.display());

    root.fill(&WHITE).map_err(failed)?;
    let (area, legend) = root.split_horizontally(SIZE.0 - LEGEND);
    let mut chart = ChartBuilder::on(&area)
        .caption(&plot.title, ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(46)
        .y_label_area_size(70)
        .build_cartesian_2d(
            (x.0..x.1).log_scale().with_key_points(ticks(x)),
            (y.0..y.1).log_scale().with_key_points(ticks(y)),
        )
        .map_err(failed)?;
    chart
        .configure_mesh()
        .x_desc("boxes")
        .y_desc(plot.y_label)
        .x_label_formatter(&label)
        .y_label_formatter(&label)
        .light_line_style(WHITE)
        .bold_line_style(RGBColor(225, 225, 225))
        .label_style(("sans-serif", 13))
        .draw()
        .map_err(failed)?;
    let mut row = 50;
    // What stands out is drawn last, over the others.
    let order = |look: Look| match look {
        Look::Faint => 0,
        Look::Line(_) => 1,
        Look::Main => 2,
    };
    for layer in 0..3 {
        for one in series.iter().filter(|one| order(one.look) == layer) {
            let style = style(one.look);
            let ends = one.points.iter().map(|&at| Circle::new(at, 3, style.filled()));
            chart.draw_series(ends).map_err(failed)?;
            let points = one.points.iter().copied();
            if is_dashed(one.look) {
                let line = DashedLineSeries::new(points, 6, 5, style);
                chart.draw_series(line).map_err(failed)?;
            } else {
                chart.draw_series(LineSeries::new(points, style)).map_err(failed)?;
            }
        }
    }
    for one in series.iter().filter(|one| order(one.look) > 0) {
        let style = style(one.look);
        let line: &[(i32, i32)] =
            if is_dashed(one.look) { &[(4, 10), (15, 21), (26, 32)] } else { &[(4, 32)] };
        for &(from, to) in line {
            let dash = PathElement::new([(from, row), (to, row)], style);
            legend.draw(&dash).map_err(failed)?;
        }
        let text = Text::new(one.name.clone(), (38, row - 7), ("sans-serif", 14).into_font());
        legend.draw(&text).map_err(failed)?;
        row += 20;
    }
    root.present().map_err(failed)
}

/// A little more than all numbers.
fn range(numbers: impl Iterator<Item = f64>) -> (f64, f64) {
    let (least, most) = numbers.fold((f64::INFINITY, 0.0f64), |(least, most), number| {
        (least.min(number), most.max(number))
    });
    if least > most { (1.0, 10.0) } else { (least / 1.3, most * 1.3) }
}

/// Where an axis has a number: at powers of ten, and between them where these are few.
fn ticks((from, to): (f64, f64)) -> Vec<f64> {
    let steps: &[f64] = match f64::log10(to / from) {
        ..1.5 => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
        1.5..2.6 => &[1.0, 2.0, 5.0],
        _ => &[1.0],
    };
    let decades = from.log10().floor() as i32..=to.log10().floor() as i32;
    let all = decades.flat_map(|decade| steps.iter().map(move |step| step * 10f64.powi(decade)));
    all.filter(|at| (from..=to).contains(at)).collect()
}

fn label(number: &f64) -> String {
    let (number, unit) = match *number {
        number if number >= 1e6 => (number / 1e6, "M"),
        number if number >= 1e3 => (number / 1e3, "k"),
        number => (number, ""),
    };
    // Three digits suffice, and hide the rounding errors of powers of ten.
    let digits = (2 - number.log10().floor() as i32).max(0) as usize;
    let text = format!("{number:.digits$}");
    let text =
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    format!("{text}{unit}")
}

/// Colors that most color-blind people can tell apart.
const COLORS: [RGBColor; 11] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(150, 150, 150),
    RGBColor(86, 180, 233),
    RGBColor(170, 40, 40),
    RGBColor(230, 159, 0),
    RGBColor(110, 75, 170),
    RGBColor(120, 150, 30),
    RGBColor(130, 85, 50),
];

fn style(look: Look) -> ShapeStyle {
    match look {
        Look::Main => BLACK.stroke_width(4),
        Look::Line(at) => COLORS[at % COLORS.len()].stroke_width(2),
        Look::Faint => RGBColor(215, 215, 215).stroke_width(1),
    }
}

fn is_dashed(look: Look) -> bool {
    matches!(look, Look::Line(at) if at / COLORS.len() % 2 == 1)
}
