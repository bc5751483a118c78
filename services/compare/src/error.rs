use pipeline::deformation_file::DeformationFileError;
use std::io;
use std::path::PathBuf;

/// Why two files cannot be compared.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// A file cannot be used.
    #[error(transparent)]
    File(#[from] DeformationFileError),
    /// The files have no time in common.
    #[error("{} and {} have no time in common", solution.display(), reference.display())]
    Apart {
        /// The solution file.
        solution: PathBuf,
        /// The reference.
        reference: PathBuf,
    },
    /// The time in common does not reach into the stretch that was asked for.
    #[error("{}, but the files have only {end:.3} s in common", asked(stretch, from))]
    Nothing {
        /// The static stretch, s.
        stretch: Option<[f64; 2]>,
        /// From when on was to be compared, s.
        from: f64,
        /// What they have in common, s.
        end: f64,
    },
    /// The output cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Output {
        /// The file.
        path: PathBuf,
        /// The operating system's answer.
        source: io::Error,
    },
    /// The numbers cannot be told as JSON.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
}

fn asked(stretch: &Option<[f64; 2]>, from: &f64) -> String {
    match stretch {
        Some([from, to]) => format!("--static {from}s..{to}s holds no instant of both files"),
        None => format!("--from {from}s leaves nothing to compare"),
    }
}

impl CompareError {
    /// Whether what the user gave cannot be used, so that nothing was compared.
    pub fn is_unusable(&self) -> bool {
        !matches!(self, Self::Output { .. } | Self::Json(_))
    }
}
