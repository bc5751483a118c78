#![allow(clippy::print_stdout)]
use experiments::*;
struct Quiet;
impl Watch for Quiet {
    fn done(&self, _c: u64) {}
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let e = EXPERIMENTS.iter().find(|e| e.name == "model-free").unwrap();
    let studies = (e.studies)();
    let from: usize = a[1].parse().unwrap();
    let to: usize = a[2].parse().unwrap();
    let plan = Plan { trials: std::num::NonZeroUsize::new(a[3].parse().unwrap()), seed: 1, quick: a.len() > 4 };
    for (i, s) in studies.iter().enumerate() {
        if i < from || i >= to {
            continue;
        }
        let t = std::time::Instant::now();
        let f = s.run(&plan, &Quiet).unwrap();
        println!("#### study {i} {:.1} s", t.elapsed().as_secs_f64());
        let mut last = String::new();
        for r in &f.rows {
            let c = &r.claim;
            if c.table != last {
                println!("## {}", c.table);
                last = c.table.clone();
            }
            println!(
                "{:60} {:6} {:6} ours {:9.3} spread {:9.3} bound {:12} paper {:30} {}",
                c.row,
                c.axis,
                c.unit,
                r.ours,
                r.spread,
                match &c.bound {
                    Bound::Value(v) => format!("{v:.3}"),
                    Bound::None(_) => "-".into(),
                },
                format!("{:?}", c.paper).chars().take(30).collect::<String>(),
                r.verdict
            );
        }
    }
}
