#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]
use messages::{ImuSample, topic};
use runtime::*;
use std::time::{Duration, Instant};
#[test]
fn child() {
    let Ok(root) = std::env::var("STORM") else { return };
    let d = Domain::open(root.as_ref()).unwrap();
    let n = Node::open(&d, "c").unwrap();
    let r = Subscriber::open(&n, &topic::main_imu()).unwrap();
    let p = Publisher::open(&n, &topic::area_imu("a")).unwrap();
    loop {
        p.publish(&ImuSample::default()).unwrap();
        r.take().unwrap();
        std::thread::sleep(Duration::from_millis(1));
    }
}
#[test]
fn storm() {
    if std::env::var("STORM").is_ok() {
        return;
    }
    for (low, high) in [(0u64, 60u64), (100, 300)] {
        let (mut poisoned_at, mut others) = (vec![], vec![]);
        let mut longest = Duration::ZERO;
        for round in 0..6u64 {
            let d = Domain::create().unwrap();
            let keep = Node::open(&d, "k").unwrap();
            let kr = Subscriber::open(&keep, &topic::area_imu("a")).unwrap();
            let mut at = None;
            for k in 0..25u64 {
                let mut c = std::process::Command::new(std::env::current_exe().unwrap())
                    .args(["child", "--exact"])
                    .env("STORM", d.root())
                    .stdout(std::process::Stdio::null())
                    .stderr(std::process::Stdio::null())
                    .spawn()
                    .unwrap();
                std::thread::sleep(Duration::from_millis(low + (round * 7919 + k * 104729) % (high - low)));
                c.kill().unwrap();
                c.wait().unwrap();
                let t = Instant::now();
                let res = (|| -> Result<(), TransportError> {
                    let n = Node::open(&d, "t")?;
                    let _p = Publisher::open(&n, &topic::area_imu("a"))?;
                    let _s = Subscriber::open(&n, &topic::main_imu())?;
                    Ok(())
                })();
                longest = longest.max(t.elapsed());
                if let Err(e) = kr.take() {
                    others.push(format!("take: {e}"));
                }
                match res {
                    Ok(()) => {}
                    Err(e) if e.is_poisoned() => {
                        at = Some((k, e.to_string()));
                        break;
                    }
                    Err(e) => others.push(e.to_string()),
                }
            }
            poisoned_at.push(at);
        }
        println!("{low}..{high} ms: poisoned {poisoned_at:#?}\nothers {others:#?} longest {longest:?}");
    }
}
