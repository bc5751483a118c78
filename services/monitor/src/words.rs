//! Flags and health in plain sentences.

use messages::{Flags, Health, Solution};

/// What each flag says to a watch.
const SENTENCES: [(Flags, &str); 20] = [
    (Flags::REGISTERING, "The installation is still being found from the ship's motion: no solution yet."),
    (Flags::UNOBSERVABLE, "The motion does not show the installation on every axis; more roll or pitch is needed."),
    (Flags::SILENT, "The area's unit gives no data: look at its cable, power and port."),
    (Flags::GAP, "Data of a unit are missing at this instant."),
    (Flags::COASTING, "The output is a prediction, because no data came."),
    (Flags::STUCK, "A gyro gives the same value all the time: its unit may be broken."),
    (Flags::ACCEL_STUCK, "An accelerometer gives the same value all the time; the gyros are still used."),
    (Flags::SATURATED, "A sensor is at the end of its measuring range."),
    (Flags::NOT_FINITE, "A unit sent values that are no numbers; they count as lost."),
    (Flags::TIME_BACK, "A unit's clock jumped back."),
    (Flags::INCONSISTENT, "The data disagree with the filter; the range has been widened by as much."),
    (Flags::RESET, "The filter met numbers that it could not use and started anew."),
    (Flags::NEW_EPOCH, "The chain of attitudes started anew."),
    (Flags::SPIKE, "A value far off was replaced by what its neighbours say."),
    (Flags::BRIDGED, "A few lost samples were bridged."),
    (Flags::LATE, "A flexure model came later than it should have."),
    (Flags::PRIOR, "The flexure model is still the first guess, not learnt from this ship."),
    (Flags::INSTALLATION, "The filter started from the configured installation, not from the motion."),
    (Flags::ZEROED, "A zero is in force: the deformation is told from where it was zeroed."),
    (Flags::INTERPOLATED, "The area's unit is read between its samples, as its clock asks."),
];

/// Flags that go with sound data and need nobody's attention.
const USUAL: Flags = Flags::INTERPOLATED;

/// Whether the solution may be used, and why it is what it is; the gravest first.
pub fn of_solution(solution: &Solution) -> Vec<&'static str> {
    let first = match solution.is_valid() {
        true => "Valid: the deformation may be used.",
        false => "NOT VALID: do not use the deformation.",
    };
    let said = SENTENCES.iter().filter(|(flag, _)| solution.flags.contains(*flag) && !USUAL.contains(*flag));
    std::iter::once(first).chain(said.map(|(_, sentence)| *sentence)).collect()
}

/// What a stage's counters tell that is not as it should be.
pub fn of_health(name: &str, health: &Health) -> Vec<String> {
    let counts = [
        (health.lost, "messages never arrived"),
        (health.missing, "samples were missing in the units' own streams"),
        (health.refused, "samples were refused"),
        (health.suspect, "samples were at the end of the range or stuck"),
        (health.overflow, "messages were dropped because a slow thread did not keep up"),
        (health.late, "flexure models came late"),
        (health.restarted_windows, "learning windows were started anew by a gap"),
    ];
    let told = counts.into_iter().filter(|(count, _)| *count > 0);
    told.map(|(count, what)| format!("{name}: {count} {what}.")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_flag_has_one_sentence() {
        let all = SENTENCES.iter().fold(Flags::empty(), |all, (flag, _)| all | *flag);
        assert_eq!((all, SENTENCES.len()), (Flags::all(), Flags::all().iter().count()));
    }

    #[test]
    fn validity_comes_first_and_what_is_usual_is_left_out() {
        let flags = Flags::INTERPOLATED | Flags::PRIOR | Flags::SILENT;
        let said = of_solution(&Solution { flags, ..Solution::default() });
        assert!(said[0].starts_with("NOT VALID") && said[1].contains("no data") && said[2].contains("first guess"));
        assert_eq!(said.len(), 3);
        assert_eq!(of_solution(&Solution { valid: 1, ..Solution::default() }).len(), 1);
    }

    #[test]
    fn only_counts_above_zero_are_told() {
        assert!(of_health("estimate", &Health::default()).is_empty());
        let said = of_health("synchronise", &Health { missing: 3, ..Health::default() });
        assert_eq!(said, ["synchronise: 3 samples were missing in the units' own streams."]);
    }
}
