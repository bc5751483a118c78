//! Figures as SVG.

mod bars;
mod frame;
mod lines;
mod scatter;

use crate::ReproduceError;
use experiments::{Figure, Plot};
use plotters::coord::Shift;
use plotters::prelude::{DrawingArea, IntoDrawingArea, RGBColor, SVGBackend, WHITE};
use std::error::Error;

/// The drawing, which scales to the page.
const WIDTH: u32 = 960;

/// Okabe and Ito's colours, which most colour-blind readers can tell apart too.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(117, 76, 36),
];
const INK: RGBColor = RGBColor(27, 31, 36);
const GRID: RGBColor = RGBColor(222, 226, 231);
const GREY: RGBColor = RGBColor(120, 130, 140);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn Error>>;

fn colour(index: usize) -> RGBColor {
    COLOURS[index % COLOURS.len()]
}

/// The figure as an `svg` element.
pub fn svg(figure: &Figure) -> Result<String, ReproduceError> {
    let mut text = String::new();
    let height = match &figure.plot {
        Plot::Lines { .. } => 420,
        Plot::Bars(bars) => bars::height(bars),
        Plot::Scatter { .. } => 560,
    };
    let drawn = {
        let area = SVGBackend::with_string(&mut text, (WIDTH, height)).into_drawing_area();
        draw(&area, &figure.plot)
    };
    match drawn {
        Ok(()) => Ok(text),
        Err(reason) => Err(ReproduceError::Drawing { title: figure.title.clone(), reason: reason.to_string() }),
    }
}

fn draw(area: &Area, plot: &Plot) -> Drawn {
    area.fill(&WHITE)?;
    match plot {
        Plot::Lines { x, y, lines } => lines::draw(area, [x, y], lines)?,
        Plot::Bars(bars) => bars::draw(area, bars)?,
        Plot::Scatter { x, y, clouds, ellipses } => scatter::draw(area, [x, y], clouds, ellipses)?,
    }
    area.present()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use experiments::{Bars, Cloud, Ellipse, Label, Line, Series, Stroke};

    fn scatter(points: Vec<(f64, f64)>) -> Plot {
        let ellipse =
            Ellipse { name: "bound, 95 %".into(), centre: (0.2, 0.5), covariance: [4e-4, 3e-4, 9e-4], sigmas: 2.45 };
        let sigma = vec![0.03; points.len()];
        let cloud = |name: &str, truth, points, sigma| Cloud { name: name.into(), truth, points, sigma };
        let clouds = vec![cloud("RVM", false, points, sigma), cloud("truth", true, vec![(0.2, 0.5)], vec![])];
        let [x, y] = [Label::new("damping", "1/s"), Label::new("frequency", "rad/s")];
        Plot::Scatter { x, y, clouds, ellipses: vec![ellipse] }
    }

    fn lines(points: Vec<(f64, f64)>) -> Plot {
        let strokes = [Stroke::Solid, Stroke::Truth, Stroke::Bound];
        let line = |stroke| Line { name: "a < b & c".into(), stroke, points: points.clone() };
        Plot::Lines { x: Label::new("time", "s"), y: Label::new("share", ""), lines: strokes.map(line).into() }
    }

    fn bars(values: Vec<(f64, f64)>) -> Plot {
        let groups = values.iter().map(|_| "method".into()).collect();
        let bounds = values.iter().map(|value| value.1).collect();
        Plot::Bars(Bars {
            value: Label::new("RMSE", "arcmin"),
            groups,
            series: vec![Series { name: "z".into(), values, bounds }],
        })
    }

    #[test]
    fn whatever_the_data_a_drawing_comes_out() {
        let data = [
            vec![],
            vec![(0.2, 0.5)],
            vec![(0.21, 0.48), (f64::NAN, 0.3), (0.18, f64::INFINITY), (0.19, 0.53)],
            vec![(1e-9, 1e-9), (2e-9, -3e-9)],
            vec![(1e12, -1e12), (2e12, 5e12)],
        ];
        for points in data {
            for plot in [scatter(points.clone()), lines(points.clone()), bars(points.clone())] {
                let figure = Figure { title: "title".into(), caption: "caption".into(), plot };
                let text = svg(&figure).unwrap_or_else(|error| panic!("{figure:?}: {error}"));
                assert!(text.starts_with("<svg") && text.trim_end().ends_with("</svg>"), "{text}");
                assert!(!text.contains("NaN") && !text.contains("a < b"), "{points:?}");
            }
        }
    }
}
