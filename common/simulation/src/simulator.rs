use crate::deck::{Deck, Leg, Run};
use crate::imu::Imu;
use crate::random::{Purpose, Source};
use crate::sampling::{NEVER, Sampling};
use crate::sea::{Motion, Sea, increments};
use crate::{Area, InsErrors, Response, Scenario};
use frames::unit::{nanoseconds, seconds};
use frames::{Main, Nav, Rot, Vec3};
use messages::{ClockDomain, Header, ImuSample, MainAttitude, Truth};

/// Everything of one main sampling instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Epoch {
    /// The main unit's sample; number k ends at k periods and covers one period.
    pub main: ImuSample,
    /// What the main INS gives for the same instant.
    pub attitude: MainAttitude,
    /// The truth of each area at the same instant.
    pub truth: Vec<Truth>,
    /// The sub units' samples that are handed out at this instant: area by area, within an area in order of arrival.
    pub sub: Vec<ImuSample>,
}

/// A scenario as it goes on, one main sample a step.
pub struct Simulator {
    sea: Sea,
    sampling: Sampling,
    next: i64,
    last_ns: i64,
    run_id: u64,
    motion: Motion,
    imu: Imu<Main>,
    ins: Ins,
    decks: Vec<Deck>,
    epoch: Epoch,
}

impl Simulator {
    /// The state before the first sample.
    pub fn new(scenario: &Scenario) -> Self {
        let Scenario { rate_hz, seed, run_id, .. } = *scenario;
        let sampling = Sampling::new(rate_hz, 0.0);
        let begin_ns = sampling.instant(-1);
        let sea = Sea::new(scenario.ship, seed, history_s(scenario));
        let run = Run { rate_hz, seed, run_id };
        let decks =
            (0..).zip(&scenario.areas).map(|(index, area)| Deck::new(area, index, &run, &sea, begin_ns)).collect();
        Self {
            motion: sea.at(begin_ns),
            sea,
            sampling,
            next: 0,
            last_ns: scenario.duration_s.map_or(NEVER, nanoseconds).min(NEVER - 1),
            run_id,
            imu: Imu::new(&scenario.main, seed, 0),
            ins: Ins::new(scenario.ins, Source::new(seed, Purpose::Ins, 0)),
            decks,
            epoch: Epoch::default(),
        }
    }

    /// The next main sampling instant; `None` after the duration.
    ///
    /// Samples that are still under way at the end come with the last epoch.
    pub fn step(&mut self) -> Option<&Epoch> {
        let time_ns = self.sampling.instant(self.next);
        if time_ns > self.last_ns {
            return None;
        }
        let sequence = self.next as u64;
        self.next += 1;
        let ended = self.sampling.instant(self.next) > self.last_ns;
        self.sea.advance(time_ns);
        let to = self.sea.at(time_ns);
        let leg = Leg { from: self.motion, to, dvel_i: self.sea.velocity_increment(&self.motion, &to) };
        self.motion = to;
        let header = header(self.run_id, sequence, time_ns);
        self.epoch.main = self.main_sample(&leg, header);
        self.epoch.attitude = self.ins.measure(to.nav_from_main, header);
        self.epoch.truth.clear();
        self.epoch.sub.clear();
        for deck in &mut self.decks {
            deck.advance(&self.sea, &leg, &mut self.epoch.sub);
            if ended {
                deck.finish(&mut self.epoch.sub);
            }
            self.epoch.truth.push(deck.truth(sequence, &to));
        }
        Some(&self.epoch)
    }

    fn main_sample(&mut self, leg: &Leg, header: Header) -> ImuSample {
        let (dtheta, dvel) = increments(leg.from.inertial_from_main, leg.to.inertial_from_main, leg.dvel_i);
        let interval_ns = leg.to.time_ns - leg.from.time_ns;
        let (dtheta, dvel) = self.imu.measure(dtheta, dvel, seconds(interval_ns));
        ImuSample { header, interval_ns, dtheta, dvel, ..ImuSample::default() }
    }
}

/// How far back a sample can reach: a unit's slowest period before one of the main unit's, and the lag of the flexure before that.
fn history_s(scenario: &Scenario) -> f64 {
    let slowest = scenario.areas.iter().map(|area| 1.0 + area.wire.rate_error).fold(1.0, f64::min);
    let period = 1.0 / scenario.rate_hz;
    let lag = |area: &Area| match area.coupling.map(|coupling| coupling.response) {
        Some(Response::Delayed { delay_s }) => delay_s,
        _ => 0.0,
    };
    period + period / slowest.max(1e-6) + scenario.areas.iter().map(lag).fold(0.0, f64::max)
}

/// The main INS with the errors that this run gave it.
struct Ins {
    constant: Vec3<Nav>,
    noise: f64,
    sigma: [f64; 3],
    source: Source,
}

impl Ins {
    fn new(errors: InsErrors, mut source: Source) -> Self {
        let [east, north, up] = source.normals();
        let constant = Vec3::new(errors.attitude[0] * east, errors.attitude[1] * north, errors.attitude[2] * up);
        let sigma = errors.attitude.map(|constant| constant.hypot(errors.noise));
        Self { constant, noise: errors.noise, sigma, source }
    }

    fn measure(&mut self, nav_from_main: Rot<Nav, Main>, header: Header) -> MainAttitude {
        let noise: Vec3<Nav> = self.source.normals().into();
        let error = Rot::<Nav, Nav>::exp(self.constant + noise * self.noise);
        MainAttitude { header, q: (error * nav_from_main).quaternion(), sigma: self.sigma }
    }
}

/// A header without stamps: the simulator has no clock.
pub(crate) fn header(run_id: u64, sequence: u64, time_ns: i64) -> Header {
    Header { run_id, sequence, time_ns, clock_domain: ClockDomain::Simulated as u32, ..Header::default() }
}
