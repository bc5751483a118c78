use super::alarms::AlarmRun;
use super::blocks::Blocks;
use super::join::Join;
use super::means::Means;
use super::ship::Heading;
use super::{Block, Envelope, Errors, Latencies, Marks, Trace};
use estimation::evaluate::{NORMAL_95, Spectrum};
use frames::{Nav, Rot, Sub, unit};
use messages::{Flags, FlexureParams, Solution, Truth};
use pipeline::configuration::{AlarmLimits, Area, Configuration};
use recording::Adoption;
use runtime::Sequence;

/// The mark of a valid solution; those below are the flags'.
pub const VALID: u64 = 1 << 32;

/// The run of one area.
pub struct AreaRun {
    /// Its name.
    pub name: String,
    /// What is worth an alarm.
    pub limits: Option<AlarmLimits>,
    /// Solutions.
    pub solutions: u64,
    /// Of them the valid ones.
    pub valid: u64,
    /// Solutions that are missing in their sequence.
    pub lost: u64,
    /// When the first valid solution came, s from the beginning.
    pub first_valid_s: Option<f64>,
    /// Deformation about each axis, arcmin; valid solutions only, as in all that follows.
    pub phi: Trace<[Envelope; 3]>,
    /// From the lower to the upper end of the 95 % range about it, arcmin.
    pub band: Trace<[Envelope; 3]>,
    /// Half width of the range, arcmin.
    pub range: Trace<[Envelope; 3]>,
    /// Roll, pitch and heading of the deck, degrees.
    pub deck: Trace<[Envelope; 3]>,
    /// Half width of the deck attitude's 95 % range about east, north, up, arcmin.
    pub deck_width: Trace<[Envelope; 3]>,
    /// Estimated delay between the units, ms.
    pub delay: Trace<Envelope>,
    /// From the lower to the upper end of its 95 % range, ms.
    pub delay_band: Trace<Envelope>,
    /// Mean of the normalised innovations squared, 1 being expected.
    pub nis: Trace<Envelope>,
    /// Flags, of all solutions, and [`VALID`].
    pub marks: Trace<Marks>,
    /// How many solutions carried each flag, by the flag's bit.
    pub flags: [u64; 32],
    /// Alarms.
    pub alarms: AlarmRun,
    /// Latencies.
    pub latencies: Latencies,
    /// Parameter sets with the times from which they are in force, s from the beginning.
    pub sets: Vec<(f64, FlexureParams)>,
    /// Sets that took effect, and of those the late ones.
    pub adopted: (u64, u64),
    /// Errors where the truth is known.
    pub errors: Errors,
    /// The last valid solution.
    pub last: Option<Solution>,
    blocks: Blocks,
    means: Means,
    join: Join,
    sequence: Sequence,
    heading: Heading,
    begin_ns: i64,
}

impl AreaRun {
    /// Nothing yet.
    pub fn new(area: &Area, configuration: &Configuration) -> Self {
        let interval_ns = configuration.interval_ns();
        let three = || Trace::new(interval_ns);
        Self {
            name: area.name.clone(),
            limits: area.alarm,
            solutions: 0,
            valid: 0,
            lost: 0,
            first_valid_s: None,
            phi: three(),
            band: three(),
            range: three(),
            deck: three(),
            deck_width: three(),
            delay: Trace::new(interval_ns),
            delay_band: Trace::new(interval_ns),
            nis: Trace::new(interval_ns),
            marks: Trace::new(interval_ns),
            flags: [0; 32],
            alarms: AlarmRun::new(area.alarm.as_ref(), interval_ns),
            latencies: Latencies::new(interval_ns),
            sets: Vec::new(),
            adopted: (0, 0),
            errors: Errors::new(&area.name, configuration.settle_s, interval_ns),
            last: None,
            blocks: Blocks::new(interval_ns),
            means: Means::new(interval_ns),
            join: Join::default(),
            sequence: Sequence::default(),
            heading: Heading::default(),
            begin_ns: 0,
        }
    }

    /// Takes a truth; the run began at `begin_ns`.
    pub fn truth(&mut self, begin_ns: i64, truth: &Truth) {
        self.begin_ns = begin_ns;
        self.join.truth(truth);
        self.work_off(false);
    }

    /// Takes a solution.
    pub fn solution(&mut self, begin_ns: i64, solution: &Solution) {
        self.begin_ns = begin_ns;
        self.join.solution(solution);
        self.work_off(false);
    }

    /// Takes a parameter set.
    pub fn parameters(&mut self, begin_ns: i64, set: &FlexureParams) {
        self.latencies.parameters(set);
        self.sets.push((unit::seconds(set.effective_from_ns.saturating_sub(begin_ns)), *set));
    }

    /// Takes the note that a set took effect.
    pub fn adoption(&mut self, adoption: &Adoption) {
        self.adopted.0 += 1;
        self.adopted.1 += u64::from(adoption.late != 0);
    }

    /// Works off what waited for a truth, and ends what is under way.
    pub fn finish(&mut self) {
        self.work_off(true);
        self.errors.close();
        self.lost = self.sequence.lost();
    }

    fn work_off(&mut self, at_end: bool) {
        while let Some((solution, truth)) = self.join.next(at_end) {
            let since_ns = solution.header.time_ns.saturating_sub(self.begin_ns);
            self.take(since_ns, &solution);
            self.errors.take(since_ns, &solution, truth.as_ref());
        }
    }

    fn take(&mut self, since_ns: i64, solution: &Solution) {
        self.solutions += 1;
        self.sequence.see(&solution.header);
        self.latencies.solution(since_ns, solution);
        self.alarms.take(since_ns, solution);
        let valid = if solution.is_valid() { VALID } else { 0 };
        let bits = solution.flags.bits();
        self.marks.take(since_ns, Marks { any: u64::from(bits) | valid });
        self.flags.iter_mut().enumerate().for_each(|(bit, count)| *count += u64::from(bits >> bit & 1));
        if !solution.is_valid() {
            return;
        }
        self.valid += 1;
        self.first_valid_s.get_or_insert(unit::seconds(since_ns));
        self.last = Some(*solution);
        if solution.nis > 0.0 {
            self.nis.take(since_ns, Envelope::of(solution.nis));
        }
        self.deformation(since_ns, solution);
        self.attitude(since_ns, solution);
        if solution.delay_sigma > 0.0 {
            let [delay, half] = [solution.delay, NORMAL_95 * solution.delay_sigma].map(|s| s * 1e3);
            self.delay.take(since_ns, Envelope::of(delay));
            self.delay_band.take(since_ns, Envelope::between(delay - half, delay + half));
        }
    }

    fn deformation(&mut self, since_ns: i64, solution: &Solution) {
        let arcmin = |v: [f64; 3]| v.map(|v| v / unit::ARCMIN);
        let (phi, range) = (arcmin(solution.phi), arcmin(solution.range));
        self.phi.take(since_ns, phi.map(Envelope::of));
        let band = |axis: usize| Envelope::between(phi[axis] - range[axis], phi[axis] + range[axis]);
        self.band.take(since_ns, [0, 1, 2].map(band));
        self.range.take(since_ns, range.map(Envelope::of));
        self.blocks.take(since_ns, phi);
        self.means.take(since_ns, phi);
    }

    fn attitude(&mut self, since_ns: i64, solution: &Solution) {
        let Some(deck) = Rot::<Nav, Sub>::from_quaternion(solution.deck) else { return };
        let euler = deck.euler();
        let heading = self.heading.next(euler.heading);
        let degrees = [euler.roll, euler.pitch, heading].map(|angle| angle / unit::DEGREE);
        self.deck.take(since_ns, degrees.map(Envelope::of));
        let width = solution.deck_sigma.map(|sigma| Envelope::of(NORMAL_95 * sigma / unit::ARCMIN));
        self.deck_width.take(since_ns, width);
    }

    /// Figures of the deformation every ten minutes, arcmin.
    pub fn blocks(&self) -> Vec<Block> {
        self.blocks.clone().finish()
    }

    /// Spectra of the deformation about each axis, arcmin^2/Hz; `None` of too little.
    pub fn spectra(&self) -> Option<[Spectrum; 3]> {
        self.means.spectra()
    }

    /// Share of solutions with a flag.
    pub fn share(&self, flag: Flags) -> f64 {
        let count = self.flags.get(flag.bits().trailing_zeros() as usize).copied().unwrap_or(0);
        count as f64 / self.solutions.max(1) as f64
    }
}
