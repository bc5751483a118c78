//! Rates and attitudes carried forward, on a ship whose motion is known.
#![allow(clippy::unwrap_used)]

use frames::{Euler, Nav, Rot, Sub, Vec3, unit::ARCSEC};
use messages::{ClockDomain, Flags, Header, Solution, Stamps};
use rand::{RngExt, SeedableRng};
use telegrams::{Moment, Motion, Track};

const MS: i64 = 1_000_000;
const SIGMA: f64 = 5.0 * ARCSEC;

/// Roll and pitch of ten degrees in eight seconds, heading in ten: the demonstration's ship.
fn angles(time_ns: i64) -> Euler {
    let swing =
        |period_s: f64, phase: f64| 0.1745 * (std::f64::consts::TAU * time_ns as f64 / 1e9 / period_s + phase).sin();
    Euler { roll: swing(8.0, 0.0), pitch: swing(8.0, 1.0), heading: 1.0 + swing(10.0, 2.0) }
}

fn deck(time_ns: i64) -> Rot<Nav, Sub> {
    angles(time_ns).rotation()
}

fn solution(time_ns: i64, deck: Rot<Nav, Sub>) -> Solution {
    let stamps = Stamps { due_ns: time_ns + 77, ..Stamps::default() };
    Solution {
        header: Header { time_ns, stamps, ..Header::default() },
        deck: deck.quaternion(),
        deck_sigma: [SIGMA; 3],
        valid: 1,
        ..Solution::default()
    }
}

/// Feeds ten seconds at 100 Hz through `change`, and gives the moment of each sample beside its time.
fn moments(lead_ns: i64, mut change: impl FnMut(usize, &mut Solution)) -> Vec<(i64, Moment)> {
    let mut track = Track::default();
    (0..1000)
        .map(|k| {
            let time_ns = k as i64 * 10 * MS;
            let mut solution = solution(time_ns, deck(time_ns));
            change(k, &mut solution);
            track.see(&solution);
            (time_ns, track.moment(&solution, lead_ns))
        })
        .collect()
}

fn off(moment: &Moment, time_ns: i64) -> [f64; 3] {
    let (told, real) = (moment.attitude.unwrap().angles, angles(time_ns));
    [told.roll - real.roll, told.pitch - real.pitch, told.heading - real.heading]
}

#[test]
fn the_attitude_is_the_solutions_own_and_its_rate_that_of_the_ship() {
    for (k, (time_ns, moment)) in moments(0, |_, _| {}).into_iter().enumerate() {
        if k < 3 {
            assert!(moment.attitude.is_none(), "no rate yet");
            continue;
        }
        assert!(off(&moment, time_ns).iter().all(|e| e.abs() < 1e-12));
        assert_eq!((moment.instant_ns, moment.extrapolated), (time_ns + 77, false));
        let (rate, step) = (moment.attitude.unwrap().rate, MS);
        let (ahead, back) = (angles(time_ns + step), angles(time_ns - step));
        for (rate, ahead, back) in [
            (rate.roll, ahead.roll, back.roll),
            (rate.pitch, ahead.pitch, back.pitch),
            (rate.heading, ahead.heading, back.heading),
        ] {
            // a rate of 15 ms ago
            assert!((rate - (ahead - back) / 2e-3).abs() < 0.025 * 0.11, "{k}");
        }
    }
}

#[test]
fn carried_forward_it_is_nearer_to_the_present_and_its_sigma_covers_it() {
    for lead_ms in [10, 20, 50] {
        let lead_ns = lead_ms * MS;
        let (mut carried, mut left) = (0f64, 0f64);
        for (time_ns, moment) in moments(lead_ns, |_, _| {}).into_iter().skip(3) {
            assert_eq!((moment.instant_ns, moment.extrapolated), (time_ns + lead_ns + 77, true));
            let sigma = moment.attitude.unwrap().sigma;
            let error = off(&moment, time_ns + lead_ns);
            for (error, sigma) in error.iter().zip([sigma.roll, sigma.pitch, sigma.heading]) {
                assert!(error.abs() < 2.0 * sigma, "{lead_ms} ms: {error} beside {sigma}");
                carried += error * error;
            }
            let (then, now) = (angles(time_ns), angles(time_ns + lead_ns));
            left += (then.roll - now.roll).powi(2)
                + (then.pitch - now.pitch).powi(2)
                + (then.heading - now.heading).powi(2);
        }
        let ratio = (carried / left).sqrt();
        assert!(ratio < 0.05, "{lead_ms} ms: the error carried forward is {ratio} of the one left");
    }
}

#[test]
fn nothing_is_carried_further_than_50_ms() {
    let mut motion = Motion::default();
    for k in 0..10 {
        motion.see(k * 10 * MS, deck(k * 10 * MS), [SIGMA; 3].into());
    }
    assert_eq!(motion.at(90 * MS, 80 * MS).unwrap().1, 140 * MS);
    assert_eq!(motion.at(110 * MS, 0).unwrap().1, 110 * MS, "a missing attitude is bridged");
    assert_eq!(motion.at(110 * MS, 50 * MS).unwrap().1, 140 * MS, "but not beyond the limit");
    assert!(motion.at(141 * MS, 0).is_none());
    assert!(motion.at(80 * MS, 0).is_none(), "nor is it carried back");
}

/// An INS of half the rate: every second solution has no attitude of its own.
#[test]
fn a_slower_ins_is_bridged() {
    let moments = moments(0, |k, solution| {
        if k % 2 == 1 {
            solution.deck = [0.0; 4];
        }
    });
    for (k, (time_ns, moment)) in moments.into_iter().enumerate().skip(8) {
        assert_eq!(moment.extrapolated, k % 2 == 1);
        assert!(off(&moment, time_ns).iter().all(|e| e.abs() < 30.0 * ARCSEC), "{k}");
    }
}

/// The heading of the main INS is set right by a degree: a step of the attitude, at no time a rate.
#[test]
fn a_step_is_no_rate() {
    let step = Rot::<Nav, Nav>::exp(Vec3::new(0.0, 0.0, -0.01745));
    let steady = moments(50 * MS, |_, _| {});
    let stepped = moments(50 * MS, |k, solution| {
        if k >= 500 {
            solution.deck = (step * deck(k as i64 * 10 * MS)).quaternion();
        }
    });
    let mut widest = 0f64;
    for (k, ((_, a), (_, b))) in steady.iter().zip(&stepped).enumerate().skip(3) {
        let (a, b) = (a.attitude.unwrap(), b.attitude.unwrap());
        let heading = b.angles.heading - a.angles.heading;
        let wanted = if k < 500 { 0.0 } else { 0.01745 };
        assert!((heading - wanted).abs() < 1e-3, "{k}: off by {heading}");
        widest = widest.max(b.sigma.heading);
    }
    assert!(widest > 0.01, "while it cannot be told from a movement the sigma says so: {widest}");
}

/// White noise of 5 arcsec on each attitude: what the rate makes of it stays within what is told.
#[test]
fn noise_is_told() {
    let mut random = rand_pcg::Pcg64::seed_from_u64(3);
    let moments = moments(20 * MS, |_, solution| {
        // a sum of twelve even numbers has a deviation of one
        let noise = [0; 3].map(|_| SIGMA * ((0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0));
        let turned = Rot::<Nav, Nav>::exp(noise.into()) * Rot::<Nav, Sub>::from_wxyz(solution.deck);
        solution.deck = turned.quaternion();
    });
    let mut outside = 0;
    for (time_ns, moment) in moments.iter().skip(3) {
        let sigma = moment.attitude.unwrap().sigma;
        let error = off(moment, time_ns + 20 * MS);
        let sigmas = [sigma.roll, sigma.pitch, sigma.heading];
        outside += error.iter().zip(sigmas).filter(|(error, sigma)| error.abs() > 3.0 * sigma).count();
    }
    assert!(outside < 3 * 997 / 25, "{outside} of {} beyond three sigmas", 3 * 997);
}

#[test]
fn what_is_not_valid_tells_no_attitude_and_begins_anew() {
    let moments = moments(0, |k, solution| {
        if k == 200 {
            solution.valid = 0;
        }
        if k == 400 {
            solution.deck[1] = f64::NAN;
        }
        if k == 600 {
            solution.flags = Flags::PRIOR;
        }
    });
    let told = |k: usize| moments[k].1.attitude.is_some();
    assert!(told(199) && !told(200) && !told(203) && told(204));
    assert!(moments[199].1.deformation.is_some() && moments[200].1.deformation.is_none());
    assert!(told(400) && moments[400].1.extrapolated, "one attitude that is no number is bridged");
    assert!(moments[600].1.report(0).reduced && !moments[601].1.report(0).reduced);
}

#[test]
fn a_host_clocks_own_time_is_the_instant() {
    let mut track = Track::default();
    let mut solution = solution(123, deck(123));
    solution.header.clock_domain = ClockDomain::HostMonotonic as u32;
    track.see(&solution);
    assert_eq!(track.moment(&solution, 0).instant_ns, 123);
}
