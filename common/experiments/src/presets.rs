//! The configurations of the experiments, embedded.

use crate::Fault;
use pipeline::configuration::Configuration;
use std::path::Path;

macro_rules! presets {
    ($($name:literal),* $(,)?) => {
        const PRESETS: &[(&str, &str, &str)] = &[
            ("demo", "config/demo.toml", include_str!("../../../config/demo.toml")),
            $((
                $name,
                concat!("config/papers/", $name, ".toml"),
                include_str!(concat!("../../../config/papers/", $name, ".toml")),
            )),*
        ];
    };
}

presets! {
    "error_range_strong",
    "error_range_strong_coherence",
    "error_range_strong_naive",
    "error_range_strong_turns",
    "error_range_weak",
    "error_range_weak_coherence",
    "error_range_weak_naive",
    "error_range_weak_turns",
    "idam",
    "idam_bayes",
    "idam_ekf",
    "idam_impulsive",
    "idam_literal",
    "idam_mcc",
    "idam_mcc_innovation",
    "idam_mpf",
    "idam_outliers",
    "idam_printed",
    "idam_shipborne",
    "idam_shipborne_static",
    "idam_so3_whittle",
    "idam_svram",
    "idam_weighted",
    "idam_whittle",
    "idam_woam",
    "model_free_1_1_large",
    "model_free_1_1_small",
    "model_free_1_2_large",
    "model_free_1_2_small",
    "model_free_1_3_large",
    "model_free_1_3_small",
    "model_free_2_1_large",
    "model_free_2_1_small",
    "model_free_2_2_large",
    "model_free_2_2_small",
    "model_free_2_3_large",
    "model_free_2_3_small",
    "model_free_a",
    "model_free_b",
    "model_free_b_previous",
    "model_free_b_time",
    "model_free_c",
    "model_free_delay",
    "model_free_delay_skew",
    "model_free_walk",
    "q_nnkf",
    "q_nnkf_ckf",
    "q_nnkf_ekf",
    "q_nnkf_nnkf",
    "q_nnkf_q_kf",
    "q_nnkf_q_nnkf",
    "q_nnkf_q_nnkf_printed",
    "q_nnkf_so3",
    "tufts_kumaresan",
    "tufts_kumaresan_band_limited",
    "tufts_kumaresan_decimated",
    "tufts_kumaresan_whittle",
}

/// Name and text of each.
pub fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    PRESETS.iter().map(|&(name, _, text)| (name, text))
}

/// The preset of a name, with the seed of a trial.
///
/// # Errors
/// There is no such preset, or it is not sound.
pub fn configuration(name: &str, seed: u64) -> Result<Configuration, Fault> {
    let (_, path, text) =
        PRESETS.iter().find(|preset| preset.0 == name).ok_or_else(|| Fault::NoSuchPreset(name.to_owned()))?;
    Ok(Configuration::parse(Path::new(path), text)?.with(|c| c.run.seed = seed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_is_sound_and_every_file_is_a_preset() {
        for (name, _) in all() {
            configuration(name, 1).unwrap_or_else(|fault| panic!("{name}: {fault}"));
        }
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/papers");
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = format!("config/papers/{}", entry.file_name().to_string_lossy());
            assert!(PRESETS.iter().any(|preset| preset.1 == path), "{path} is no preset");
        }
        assert!(matches!(configuration("nowhere", 1), Err(Fault::NoSuchPreset(_))));
    }
}
