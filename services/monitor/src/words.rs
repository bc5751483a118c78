//! Flags and health in plain sentences.

use messages::{Flags, Health, Solution};

/// Flags that go with sound data and need nobody's attention.
const USUAL: Flags = Flags::INTERPOLATED;

/// Whether the solution may be used, and why it is what it is; the gravest first.
pub fn of_solution(solution: &Solution) -> Vec<&'static str> {
    let first = match solution.is_valid() {
        true => "Valid: the deformation may be used.",
        false => "NOT VALID: do not use the deformation.",
    };
    let said = Flags::SENTENCES.iter().filter(|(flag, _)| solution.flags.contains(*flag) && !USUAL.contains(*flag));
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
