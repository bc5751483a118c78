use super::frame::{Entry, Sign, chart, range};
use super::{Area, Drawn, GREY, INK, colour};
use experiments::{Label, Line, Stroke};
use plotters::prelude::{DashedLineSeries, LineSeries};
use plotters::style::{Color, ShapeStyle};

/// So many points show all that a drawing of this width can.
const MOST: usize = 2000;

/// Draws lines, those of one name in one colour.
pub fn draw(area: &Area, labels: [&Label; 2], lines: &[Line]) -> Drawn {
    let mut entries: Vec<Entry> = Vec::new();
    let mut styles = Vec::new();
    for line in lines {
        let known = entries.iter().position(|entry| entry.name == line.name);
        let index = known.unwrap_or_else(|| {
            let solid =
                entries.iter().filter(|entry| entry.sign == Sign::Line && entry.style.stroke_width == 2).count();
            entries.push(entry(line, solid));
            entries.len() - 1
        });
        styles.push(entries[index].style);
    }
    let all = || lines.iter().flat_map(|line| &line.points);
    let x = all().map(|point| point.0).filter(|x| x.is_finite());
    let (low, high) = x.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let x = if low < high { low..high } else { range(all().map(|point| point.0)) };
    let mut chart = chart(area, labels, [x, range(all().map(|point| point.1))], &entries)?;
    for (line, style) in lines.iter().zip(styles) {
        let finite = |point: &(f64, f64)| point.0.is_finite() && point.1.is_finite();
        for piece in line.points.split(|point| !finite(point)).filter(|piece| !piece.is_empty()) {
            let points = thinned(piece);
            match line.stroke {
                Stroke::Truth => chart.draw_series(DashedLineSeries::new(points, 8, 5, style)).map(|_| ())?,
                _ => chart.draw_series(LineSeries::new(points, style)).map(|_| ())?,
            }
        }
    }
    Ok(())
}

fn entry(line: &Line, solid: usize) -> Entry {
    let (sign, colour, width) = match line.stroke {
        Stroke::Solid => (Sign::Line, colour(solid), 2),
        Stroke::Truth => (Sign::Dashes, INK, 2),
        Stroke::Bound => (Sign::Line, GREY, 1),
    };
    Entry { name: line.name.clone(), sign, style: ShapeStyle { stroke_width: width, ..colour.stroke_width(width) } }
}

/// The lowest and the highest point of each of as many stretches as can be told apart, so that no peak is lost.
fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    if points.len() <= MOST {
        return points.to_vec();
    }
    let mut kept = Vec::with_capacity(MOST + 2);
    for stretch in points.chunks(points.len().div_ceil(MOST / 2)) {
        let by = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let ends = stretch.iter().min_by(by).zip(stretch.iter().max_by(by));
        if let Some((low, high)) = ends {
            kept.extend(if low.0 <= high.0 { [*low, *high] } else { [*high, *low] });
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_order_and_peaks() {
        let mut points: Vec<(f64, f64)> = (0..100_000).map(|i| (f64::from(i), (f64::from(i) * 1e-3).sin())).collect();
        points[54_321].1 = 7.0;
        let kept = thinned(&points);
        assert!(kept.len() <= MOST + 2 && kept.len() > MOST / 2);
        assert!(kept.iter().any(|point| point.1 == 7.0));
        assert!(kept.windows(2).all(|pair| pair[0].0 <= pair[1].0));
        assert_eq!(thinned(&points[..10]), &points[..10]);
    }
}
