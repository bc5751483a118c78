use experiments::{EXPERIMENTS, Experiment};
use std::collections::BTreeSet;
use std::str::FromStr;

/// One experiment, those of a group, or all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Selection(Option<&'static str>);

/// There is no experiment of this name.
#[derive(Debug, thiserror::Error)]
#[error("there is no experiment \"{0}\"; known are {known} and all", known = names().join(", "))]
pub struct UnknownExperiment(String);

fn names() -> Vec<&'static str> {
    let mut names: Vec<_> =
        EXPERIMENTS.iter().flat_map(|experiment| [Some(experiment.name), experiment.group]).flatten().collect();
    let mut told = BTreeSet::new();
    names.retain(|name| told.insert(*name));
    names
}

impl Selection {
    /// Those that are selected, in the order of the output.
    pub fn experiments(self) -> impl Iterator<Item = &'static Experiment> + Clone {
        EXPERIMENTS.iter().filter(move |experiment| {
            self.0.is_none_or(|name| name == experiment.name || experiment.group == Some(name))
        })
    }
}

impl FromStr for Selection {
    type Err = UnknownExperiment;

    fn from_str(text: &str) -> Result<Self, UnknownExperiment> {
        match text {
            "all" => Ok(Self(None)),
            _ => match names().into_iter().find(|name| *name == text) {
                Some(name) => Ok(Self(Some(name))),
                None => Err(UnknownExperiment(text.to_owned())),
            },
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_name_selects_one_a_group_its_own_and_all_every_experiment() {
        let count = |name: &str| name.parse::<Selection>().unwrap().experiments().count();
        assert_eq!((count("idam"), count("deck-parts"), count("all")), (1, 1, EXPERIMENTS.len()));
        assert_eq!(count("deck"), EXPERIMENTS.iter().filter(|experiment| experiment.name.starts_with("deck-")).count());
        let refused = "decks".parse::<Selection>().unwrap_err().to_string();
        assert!(["deck,", "deck-coupling", "idam"].iter().all(|name| refused.contains(name)), "{refused}");
        assert_eq!(refused.matches("deck,").count(), 1);
    }
}
