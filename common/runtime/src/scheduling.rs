//! Scheduling classes: the fast stages ahead of all else where the operating system grants it, the identifier behind.

use messages::Scheduling;

/// What a stage asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// The ordinary class, without trying for more.
    Normal,
    /// Real time where it is granted; the ordinary class is as good.
    Auto,
    /// Real time; whoever asks should warn where it is not granted.
    Fifo,
}

/// Asks for a scheduling class and gives the one obtained: [`Scheduling::Fifo`] or [`Scheduling::Normal`].
///
/// `priority` is that of the real-time class, 1 to 99. It holds for the calling thread; threads it starts later are ordinary ones.
/// With the real-time class the memory of the process is locked, as far as that is allowed without limit.
pub fn apply(request: Request, priority: i32) -> Scheduling {
    match request {
        Request::Normal => Scheduling::Normal,
        Request::Auto | Request::Fifo => {
            let parameters = libc::sched_param { sched_priority: priority };
            let policy = libc::SCHED_FIFO | libc::SCHED_RESET_ON_FORK;
            // SAFETY: 0 is the calling thread and the parameters live through the call.
            if unsafe { libc::sched_setscheduler(0, policy, &parameters) } != 0 {
                return Scheduling::Normal;
            }
            lock_memory();
            Scheduling::Fifo
        }
    }
}

/// Puts the calling thread, and the threads and processes it starts later, behind all ordinary ones.
pub fn lower() -> Scheduling {
    let parameters = libc::sched_param { sched_priority: 0 };
    // SAFETY: 0 is the calling thread and the parameters live through the call.
    let (batch, nice) = unsafe {
        let batch = libc::sched_setscheduler(0, libc::SCHED_BATCH, &parameters) == 0;
        (batch, libc::setpriority(libc::PRIO_PROCESS, 0, 10) == 0)
    };
    if batch || nice { Scheduling::Low } else { Scheduling::Normal }
}

/// Under a limit, locking would make later mappings of shared memory fail, which is worse than a page fault. Pages are locked
/// as they are touched, since most of a deep topic's memory never is.
fn lock_memory() {
    let mut limit = libc::rlimit { rlim_cur: 0, rlim_max: 0 };
    // SAFETY: the pointer is valid and the flags are constants of the call.
    unsafe {
        let known = libc::getrlimit(libc::RLIMIT_MEMLOCK, &mut limit) == 0;
        if libc::geteuid() == 0 || (known && limit.rlim_cur == libc::RLIM_INFINITY) {
            libc::mlockall(libc::MCL_CURRENT | libc::MCL_FUTURE | libc::MCL_ONFAULT);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In a thread of its own, for the class stays with the thread.
    fn in_thread<T: Send + 'static>(body: impl FnOnce() -> T + Send + 'static) -> T {
        std::thread::spawn(body).join().expect("the body does not panic")
    }

    fn policy() -> i32 {
        // SAFETY: 0 is the calling thread.
        unsafe { libc::sched_getscheduler(0) }
    }

    #[test]
    fn what_is_reported_is_what_was_obtained() {
        for request in [Request::Normal, Request::Auto, Request::Fifo] {
            let (scheduling, policy) = in_thread(move || (apply(request, 10), policy()));
            let fifo = policy & !libc::SCHED_RESET_ON_FORK == libc::SCHED_FIFO;
            assert_eq!(scheduling == Scheduling::Fifo, fifo, "{request:?}");
            assert!(request != Request::Normal || !fifo);
        }
    }

    #[test]
    fn an_impossible_priority_falls_back() {
        assert_eq!(in_thread(|| apply(Request::Fifo, 1000)), Scheduling::Normal);
    }

    #[test]
    fn threads_of_a_fifo_thread_are_ordinary() {
        let policy = in_thread(|| {
            apply(Request::Auto, 10);
            in_thread(policy)
        });
        assert_eq!(policy, libc::SCHED_OTHER);
    }

    #[test]
    fn the_low_class_is_batch() {
        let (scheduling, policy) = in_thread(|| (lower(), policy()));
        assert_eq!((scheduling, policy), (Scheduling::Low, libc::SCHED_BATCH));
    }
}
