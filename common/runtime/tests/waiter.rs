//! Waking and not waking. Times are generous: what counts is order and number.
#![allow(clippy::unwrap_used)]

use messages::topic;
use messages::{ImuSample, Message};
use runtime::{Domain, Node, Publisher, Subscriber, Waiter, Wake};
use std::sync::mpsc;
use std::time::{Duration, Instant};

const LONG: Duration = Duration::from_secs(20);

fn sample(k: u64) -> ImuSample {
    let mut sample = ImuSample::default();
    sample.header_mut().sequence = k;
    sample
}

fn thread_cpu() -> Duration {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer is valid.
    assert_eq!(unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) }, 0);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

#[test]
fn an_idle_waiter_sleeps_through_its_timeout() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "node").unwrap();
    let writer = Publisher::open(&node, &topic::main_imu()).unwrap();
    let reader = Subscriber::open(&node, &topic::main_imu()).unwrap();
    let other = Subscriber::open(&node, &topic::area_imu("aft")).unwrap();
    let mut waiter = Waiter::new();
    // Events of the past are consumed and leave nothing behind that keeps it awake.
    for k in 0..100 {
        writer.publish(&sample(k)).unwrap();
    }
    waiter.wait(&[&reader, &other], LONG).unwrap();
    let (start, cpu) = (Instant::now(), thread_cpu());
    for _ in 0..3 {
        let start = Instant::now();
        waiter.wait(&[&reader, &other], Duration::from_millis(300)).unwrap();
        assert!(start.elapsed() >= Duration::from_millis(300), "woke after {:?}", start.elapsed());
    }
    let cpu = thread_cpu() - cpu;
    assert!(cpu < start.elapsed() / 20, "{cpu:?} of processor time in {:?}", start.elapsed());
}

#[test]
fn news_on_any_topic_wake() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "node").unwrap();
    let topics = [topic::main_imu(), topic::area_imu("fore"), topic::area_imu("aft")];
    let readers: Vec<_> = topics.iter().map(|topic| Subscriber::open(&node, topic).unwrap()).collect();
    let wakes: Vec<&dyn Wake> = readers.iter().map(|reader| reader as &dyn Wake).collect();
    let mut waiter = Waiter::new();
    for (topic, reader) in topics.iter().zip(&readers) {
        let writer = Publisher::open(&node, topic).unwrap();
        writer.publish(&sample(1)).unwrap();
        let start = Instant::now();
        while reader.take().unwrap().is_none() {
            waiter.wait(&wakes, LONG).unwrap();
        }
        assert!(start.elapsed() < LONG);
    }
}

/// So that the reader connects even to a writer that leaves soon.
#[test]
fn the_coming_of_a_writer_wakes() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "node").unwrap();
    let reader = Subscriber::open(&node, &topic::main_imu()).unwrap();
    let mut waiter = Waiter::new();
    for k in 0..3 {
        let writer = Publisher::open(&node, &topic::main_imu()).unwrap();
        let start = Instant::now();
        waiter.wait(&[&reader], LONG).unwrap();
        assert!(start.elapsed() < LONG);
        assert_eq!(reader.take().unwrap(), None);
        writer.publish(&sample(k)).unwrap();
        drop(writer);
        assert_eq!(reader.take().unwrap(), Some(sample(k)));
        waiter.wait(&[&reader], LONG).unwrap();
    }
}

/// Two threads that answer each other: were one wake-up lost, the exchange would hang until the time-out.
#[test]
fn no_wake_up_is_lost() {
    const ROUNDS: u64 = 5000;
    let domain = Domain::create().unwrap();
    let (there, back) = (topic::main_imu(), topic::area_imu("aft"));
    let (ready, echo_is_ready) = mpsc::channel();
    std::thread::scope(|scope| {
        let (domain, to, from) = (&domain, &back, &there);
        scope.spawn(move || {
            let node = Node::open(domain, "echo").unwrap();
            let (writer, reader) = (Publisher::open(&node, to).unwrap(), Subscriber::open(&node, from).unwrap());
            ready.send(()).unwrap();
            let mut waiter = Waiter::new();
            let mut answered = 0;
            while answered < ROUNDS {
                waiter.wait(&[&reader], LONG).unwrap();
                while let Some(message) = reader.take().unwrap() {
                    writer.publish(&message).unwrap();
                    answered += 1;
                }
            }
        });
        let node = Node::open(domain, "caller").unwrap();
        let (writer, reader) = (Publisher::open(&node, &there).unwrap(), Subscriber::open(&node, &back).unwrap());
        echo_is_ready.recv().unwrap();
        let mut waiter = Waiter::new();
        for k in 0..ROUNDS {
            writer.publish(&sample(k)).unwrap();
            let start = Instant::now();
            let answer = loop {
                waiter.wait(&[&reader], LONG).unwrap();
                if let Some(answer) = reader.take().unwrap() {
                    break answer;
                }
            };
            assert_eq!(answer.header.sequence, k);
            assert!(start.elapsed() < LONG, "round {k} needed the time-out");
        }
    });
}

#[test]
fn a_signal_ends_the_wait() {
    extern "C" fn nothing(_: libc::c_int) {}
    // SAFETY: the handler does nothing and the signal is not used otherwise.
    unsafe { libc::signal(libc::SIGUSR1, nothing as *const () as libc::sighandler_t) };
    // SAFETY: the calling thread exists.
    let (waiting, done) = (unsafe { libc::pthread_self() }, mpsc::channel::<()>());
    std::thread::scope(|scope| {
        let (finished, finish) = done;
        scope.spawn(move || {
            // Sent again and again, for one that comes before the wait does not end it.
            while finish.recv_timeout(Duration::from_millis(20)) == Err(mpsc::RecvTimeoutError::Timeout) {
                // SAFETY: the thread lives until the scope ends.
                unsafe { libc::pthread_kill(waiting, libc::SIGUSR1) };
            }
        });
        let start = Instant::now();
        Waiter::new().wait(&[], LONG).unwrap();
        assert!(start.elapsed() < LONG);
        drop(finished);
    });
}
