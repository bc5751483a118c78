use estimation::evaluate::Stretch;
use frames::unit;
use std::ops::Range;

/// Length of a block, ns.
const LENGTH_NS: i64 = 600_000_000_000;

/// Figures of a block of ten minutes.
#[derive(Clone, Debug)]
pub struct Block {
    /// From and to, s from the beginning; the last block ends with the last value.
    pub time_s: Range<f64>,
    /// For how long there were values, s.
    pub covered_s: f64,
    /// Of each component.
    pub components: [Stretch; 3],
}

/// Figures of three components every ten minutes. Only one block's values are held.
#[derive(Clone, Debug)]
pub struct Blocks {
    interval_ns: i64,
    number: i64,
    values: [Vec<(f64, f64)>; 3],
    done: Vec<Block>,
}

impl Blocks {
    /// Of values that come so often.
    pub fn new(interval_ns: i64) -> Self {
        Self { interval_ns: interval_ns.max(1), number: 0, values: Default::default(), done: Vec::new() }
    }

    /// Takes in values so long after the beginning.
    pub fn take(&mut self, time_ns: i64, values: [f64; 3]) {
        if values.iter().any(|value| !value.is_finite()) {
            return;
        }
        let number = time_ns.max(0) / LENGTH_NS;
        if number != self.number {
            self.close();
            self.number = number;
        }
        let t = unit::seconds(time_ns);
        self.values.iter_mut().zip(values).for_each(|(series, value)| series.push((t, value)));
    }

    fn close(&mut self) {
        let hole_s = 2.5 * unit::seconds(self.interval_ns);
        let [x, y, z] = &self.values;
        if let (Some(x), Some(y), Some(z)) = (Stretch::of(x, hole_s), Stretch::of(y, hole_s), Stretch::of(z, hole_s)) {
            let begin_s = unit::seconds(self.number.saturating_mul(LENGTH_NS));
            let end_s = self.values[0].last().map_or(begin_s, |(t, _)| *t);
            let covered_s = x.count as f64 * unit::seconds(self.interval_ns);
            self.done.push(Block { time_s: begin_s..end_s, covered_s, components: [x, y, z] });
        }
        self.values.iter_mut().for_each(Vec::clear);
    }

    /// The blocks with values, in order.
    pub fn finish(mut self) -> Vec<Block> {
        self.close();
        let full_s = unit::seconds(LENGTH_NS);
        let before_last = self.done.len().saturating_sub(1);
        self.done[..before_last].iter_mut().for_each(|block| block.time_s.end = block.time_s.start + full_s);
        self.done
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_ten_minutes_have_their_own_figures() {
        let mut blocks = Blocks::new(unit::nanoseconds(0.1));
        for i in 0..9000i64 {
            let t = 0.1 * i as f64;
            let size = if t < 600.0 { 1.0 } else { 3.0 };
            blocks.take(i * unit::nanoseconds(0.1), [size * t.sin(), size, f64::from(u8::from(i == 8000))]);
        }
        blocks.take(unit::nanoseconds(900.0), [f64::NAN, 0.0, 0.0]);
        let found = blocks.finish();
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].time_s.clone(), found[1].time_s.start), (0.0..600.0, 600.0));
        assert!((found[1].time_s.end - 899.9).abs() < 1e-6 && (found[1].covered_s - 300.0).abs() < 1e-6);
        let x = found.iter().map(|block| block.components[0]).collect::<Vec<_>>();
        assert!((x[0].most - 1.0).abs() < 1e-3 && (x[1].most - 3.0).abs() < 3e-3);
        let period = x[0].period_s.unwrap_or(0.0);
        assert!((period - std::f64::consts::TAU).abs() < 1e-3, "{period}");
        assert_eq!((found[1].components[1].deviation, found[1].components[2].most), (0.0, 1.0));
    }

    #[test]
    fn nothing_has_no_block() {
        assert!(Blocks::new(1).finish().is_empty());
    }
}
