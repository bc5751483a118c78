use crate::TransportError;
use signal_hook::consts::{SIGINT, SIGTERM};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the process has been asked to stop, by SIGINT or SIGTERM.
#[derive(Clone, Debug)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Takes over the two signals for the rest of the process's life.
    ///
    /// # Errors
    /// If the operating system refuses.
    pub fn install() -> Result<Self, TransportError> {
        let flag = Arc::new(AtomicBool::new(false));
        for signal in [SIGINT, SIGTERM] {
            signal_hook::flag::register(signal, Arc::clone(&flag))
                .map_err(|source| TransportError::System { call: "installing a signal handler", source })?;
        }
        Ok(Self(flag))
    }

    /// Whether one of the signals has come.
    pub fn requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Has a write beyond the limit of a file's size fail like one on a full disk, instead of ending the process.
///
/// # Errors
/// If the operating system refuses.
pub fn fail_beyond_file_limit() -> Result<(), TransportError> {
    // SAFETY: the signal number and the disposition are constants of the call.
    match unsafe { libc::signal(libc::SIGXFSZ, libc::SIG_IGN) } {
        libc::SIG_ERR => Err(TransportError::last_os("signal")),
        _ => Ok(()),
    }
}

/// Has SIGTERM sent to this process when its parent dies, so that no stage outlives its launcher.
///
/// The kernel watches the THREAD that started this process: a launcher must start its stages from a thread that lives as long as
/// itself. A parent that died even before this call is noticed by [`crate::Domain::open`].
///
/// # Errors
/// [`TransportError::Orphaned`] if the parent died meanwhile.
pub fn die_with_parent() -> Result<(), TransportError> {
    // SAFETY: neither call has preconditions; the signal number is valid.
    unsafe {
        let parent = libc::getppid();
        if libc::prctl(libc::PR_SET_PDEATHSIG, libc::SIGTERM as libc::c_ulong) != 0 {
            return Err(TransportError::last_os("prctl"));
        }
        if libc::getppid() != parent {
            return Err(TransportError::Orphaned);
        }
    }
    Ok(())
}
