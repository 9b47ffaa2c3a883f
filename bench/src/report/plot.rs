//! The plots, in SVG: a scene's times against the number of boxes, and the advantage over the
//! fastest rival.

use std::path::Path;

use anyhow::{Result, anyhow};
use plotters::prelude::*;

use super::table::{GOALS, advantage, names, scenes};
use crate::peers::OURS;
use crate::record::{Case, Record};

const SIZE: (u32, u32) = (900, 560);

/// A line of a plot, its points in ascending x.
struct Series {
    name: String,
    points: Vec<(f64, f64)>,
    style: ShapeStyle,
}

/// Writes the plots into the folder and returns their file names.
pub fn write(record: &Record, folder: &Path) -> Result<Vec<String>> {
    let mut written = Vec::new();
    let mut advantages = Vec::new();
    // Over all cases, so that a contender has the same colour in every plot.
    let contenders = names(&record.cases.iter().collect::<Vec<_>>());
    for (scene, dimensions) in scenes(record) {
        let mut cases: Vec<_> = record
            .cases
            .iter()
            .filter(|case| case.scene == scene && case.dimensions == dimensions)
            .collect();
        cases.sort_by_key(|case| case.boxes);
        let point = |case: &&Case| Some((case.boxes as f64, advantage(case)?));
        advantages.push(Series {
            name: format!("{scene} {dimensions}D"),
            points: cases.iter().filter_map(point).collect(),
            style: colour(advantages.len()).stroke_width(2),
        });
        let file = format!("{}-{dimensions}d.svg", scene.replace(['/', '.'], "-"));
        let title = format!("{scene} {dimensions}D: time to find all pairs");
        draw(&folder.join(&file), &title, "milliseconds", times(&cases, &contenders))?;
        written.push(file);
    }
    advantages.push(Series {
        name: "goal of the mean".into(),
        points: GOALS.map(|(boxes, goal)| (boxes as f64, goal)).to_vec(),
        style: BLACK.stroke_width(4),
    });
    let title = "How many times ours the fastest rival takes";
    draw(&folder.join("advantage.svg"), title, "fastest rival / ours", advantages)?;
    written.insert(0, "advantage.svg".into());
    Ok(written)
}

fn times(cases: &[&Case], contenders: &[String]) -> Vec<Series> {
    let series = |(at, name): (usize, &String)| {
        let point = |case: &&Case| Some((case.boxes as f64, case.times(name)?.median_ns / 1e6));
        let style = if name == OURS { BLACK.stroke_width(4) } else { colour(at).stroke_width(2) };
        Series { points: cases.iter().filter_map(point).collect(), style, name: name.clone() }
    };
    contenders.iter().enumerate().map(series).collect()
}

/// A log-log plot with the legend outside on the right.
fn draw(path: &Path, title: &str, y_label: &str, mut series: Vec<Series>) -> Result<()> {
    series.retain(|series| !series.points.is_empty());
    let points = || series.iter().flat_map(|series| &series.points);
    let x = range(points().map(|point| point.0));
    let y = range(points().map(|point| point.1));
    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    let failed = |error| anyhow!("drawing {}: {error}", path.display());

    root.fill(&WHITE).map_err(|error| anyhow!("drawing {}: {error}", path.display()))?;
    let (plot, legend) = root.split_horizontally(SIZE.0 - 210);
    let mut chart = ChartBuilder::on(&plot)
        .caption(title, ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(46)
        .y_label_area_size(70)
        .build_cartesian_2d((x.0..x.1).log_scale(), (y.0..y.1).log_scale())
        .map_err(failed)?;
    chart
        .configure_mesh()
        .x_desc("boxes")
        .y_desc(y_label)
        .x_label_formatter(&label)
        .y_label_formatter(&label)
        .light_line_style(WHITE)
        .label_style(("sans-serif", 13))
        .draw()
        .map_err(failed)?;
    for (at, one) in series.iter().enumerate() {
        let line = LineSeries::new(one.points.iter().copied(), one.style);
        chart.draw_series(line).map_err(failed)?;
        let dots = one.points.iter().map(|&point| Circle::new(point, 3, one.style.filled()));
        chart.draw_series(dots).map_err(failed)?;
        let y = 50 + 20 * at as i32;
        legend.draw(&PathElement::new([(4, y), (28, y)], one.style)).map_err(failed)?;
        let text = Text::new(one.name.clone(), (34, y - 7), ("sans-serif", 14).into_font());
        legend.draw(&text).map_err(failed)?;
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

/// Numbers with one digit other than zero, and of those only 1, 2 and 5: the others are crowded.
fn label(number: &f64) -> String {
    let digits = format!("{number:e}");
    match digits.split('e').next() {
        Some("1" | "2" | "5") if *number >= 1e6 => format!("{}M", number / 1e6),
        Some("1" | "2" | "5") if *number >= 1e3 => format!("{}k", number / 1e3),
        Some("1" | "2" | "5") => format!("{number}"),
        _ => String::new(),
    }
}

/// Colours that stay apart, for so many lines as there are contenders.
fn colour(at: usize) -> RGBColor {
    const COLOURS: [RGBColor; 18] = [
        RGBColor(31, 119, 180),
        RGBColor(130, 130, 130),
        RGBColor(44, 160, 44),
        RGBColor(190, 190, 190),
        RGBColor(255, 127, 14),
        RGBColor(214, 39, 40),
        RGBColor(148, 103, 189),
        RGBColor(140, 86, 75),
        RGBColor(227, 119, 194),
        RGBColor(188, 189, 34),
        RGBColor(23, 190, 207),
        RGBColor(0, 70, 140),
        RGBColor(110, 180, 110),
        RGBColor(255, 187, 120),
        RGBColor(140, 20, 60),
        RGBColor(80, 80, 0),
        RGBColor(0, 110, 110),
        RGBColor(120, 60, 200),
    ];
    COLOURS[at % COLOURS.len()]
}
