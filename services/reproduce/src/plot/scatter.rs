use super::frame::{Entry, Sign, chart, range};
use super::{Area, Drawn, INK, colour};
use experiments::{Cloud, Ellipse, Label};
use plotters::prelude::{Circle, Cross, LineSeries, PathElement};
use plotters::style::{Color, RGBColor};

/// Draws points with their error bars over the ellipses.
pub fn draw(area: &Area, labels: [&Label; 2], clouds: &[Cloud], ellipses: &[Ellipse]) -> Drawn {
    let colours = colours(clouds);
    let of_cloud = |(cloud, colour): (&Cloud, &RGBColor)| Entry {
        name: cloud.name.clone(),
        sign: if cloud.truth { Sign::Cross } else { Sign::Dot },
        style: colour.stroke_width(3),
    };
    let shades = ellipses.iter().enumerate().map(|(index, _)| colour(clouds.len() + index));
    let shades: Vec<RGBColor> = shades.collect();
    let of_ellipse = |(ellipse, colour): (&Ellipse, &RGBColor)| Entry {
        name: ellipse.name.clone(),
        sign: Sign::Line,
        style: colour.stroke_width(2),
    };
    let entries = clouds.iter().zip(&colours).map(of_cloud).chain(ellipses.iter().zip(&shades).map(of_ellipse));
    let entries: Vec<Entry> = entries.collect();
    let outlines: Vec<Vec<(f64, f64)>> = ellipses.iter().map(Ellipse::outline).collect();
    let places = || clouds.iter().flat_map(bars).chain(outlines.iter().flatten().copied());
    let ranges = [range(places().map(|point| point.0)), range(places().map(|point| point.1))];
    let mut chart = chart(area, labels, ranges, &entries)?;
    for (outline, colour) in outlines.into_iter().zip(shades) {
        if outline.iter().all(|point| is_finite(*point)) {
            chart.draw_series(LineSeries::new(outline, colour.stroke_width(2)))?;
        }
    }
    for (cloud, colour) in clouds.iter().zip(colours) {
        let points = || cloud.points.iter().copied().filter(|point| is_finite(*point));
        if cloud.truth {
            chart.draw_series(points().map(|point| Cross::new(point, 8, colour.stroke_width(3))))?;
            continue;
        }
        let ends: Vec<(f64, f64)> = bars(cloud).collect();
        let whiskers = ends.chunks_exact(2).filter(|ends| ends.iter().all(|end| is_finite(*end)) && ends[0] != ends[1]);
        chart.draw_series(whiskers.map(|ends| PathElement::new(ends.to_vec(), colour.mix(0.5).stroke_width(1))))?;
        chart.draw_series(points().map(|point| Circle::new(point, 4, colour.mix(0.75).filled())))?;
    }
    Ok(())
}

/// The truth is black and takes no colour from the others.
fn colours(clouds: &[Cloud]) -> Vec<RGBColor> {
    clouds.iter().enumerate().map(|(index, cloud)| if cloud.truth { INK } else { colour(index) }).collect()
}

fn is_finite((x, y): (f64, f64)) -> bool {
    x.is_finite() && y.is_finite()
}

/// The two ends of each point's error bar, the point itself twice where it has none.
fn bars(cloud: &Cloud) -> impl Iterator<Item = (f64, f64)> + '_ {
    cloud.points.iter().enumerate().flat_map(|(index, &(x, y))| {
        let sigma = cloud.sigma.get(index).copied().filter(|sigma| sigma.is_finite()).unwrap_or(0.0);
        [(x, y - sigma), (x, y + sigma)]
    })
}
