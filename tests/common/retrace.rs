//! Computes the rows of a run anew from what the rows themselves say: which samples there were and which parameters were in force.

use super::first_difference;
use messages::{FlexureParams, ImuPair, Solution};
use pipeline::configuration::Configuration;
use pipeline::lane;
use pipeline::solution_file::SolutionFile;
use pipeline::source::{Batch, Source};
use std::collections::{BTreeMap, HashMap};

/// Distance of an estimator's checkpoints.
const CHECKPOINT_NS: i64 = 1_000_000_000;

/// The columns of a row that tell what the stages had before them.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    pub params_id: u64,
    pub valid: bool,
    /// The flag `gap`: a unit's sample was missing.
    pub gap: bool,
    /// Whether there is an attitude of the deck, for which the main INS's is needed.
    pub deck: bool,
}

/// Which samples the missing rows were missing to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Missing {
    /// The estimator only: it did not run, the synchroniser did.
    #[default]
    Pairs,
    /// The synchroniser too.
    Samples,
    /// The synchroniser too, but for the first sub sample: the source was killed between its two units' samples.
    SamplesButOne,
}

/// What happened in a run; the numbers are those of the first sample that a process started anew took part in.
#[derive(Clone, Copy, Debug, Default)]
pub struct Story {
    pub missing: Missing,
    pub synchroniser: Option<u64>,
    pub estimator: Option<u64>,
    /// The checkpoint that the new estimator goes on from: 0 is the last before it.
    pub checkpoint: Option<usize>,
    /// The first point of the new identifier's window.
    pub identifier: Option<u64>,
}

/// The rows of a solution file by sample number, in strictly rising order.
pub fn rows(configuration: &Configuration, text: &str) -> BTreeMap<u64, Row> {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let place = |name: &str| names.iter().position(|n| *n == name).unwrap();
    let [t_s, valid, params_id, flags, roll] = ["t_s", "valid", "params_id", "flags", "roll_deg"].map(place);
    let mut rows = BTreeMap::new();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells.len(), names.len(), "{line}");
        let sequence = cells[t_s].parse::<f64>().unwrap() * configuration.rate_hz;
        assert!((sequence - sequence.round()).abs() < 1e-3, "{line}");
        let row = Row {
            params_id: cells[params_id].parse().unwrap(),
            valid: cells[valid] == "1",
            gap: cells[flags].split('|').any(|flag| flag == "gap"),
            deck: !cells[roll].is_empty(),
        };
        let sequence = sequence.round() as u64;
        assert!(rows.last_key_value().is_none_or(|(last, _)| *last < sequence), "out of order: {line}");
        rows.insert(sequence, row);
    }
    rows
}

/// The holes in the rows: the last number before and the first after each.
pub fn holes(rows: &BTreeMap<u64, Row>) -> Vec<(u64, u64)> {
    let numbers: Vec<u64> = rows.keys().copied().collect();
    numbers.windows(2).filter(|pair| pair[1] != pair[0] + 1).map(|pair| (pair[0], pair[1])).collect()
}

/// The parameter sets in force, in the order in which they came.
pub fn sets(rows: &BTreeMap<u64, Row>) -> Vec<u64> {
    let mut ids: Vec<u64> = rows.values().map(|row| row.params_id).filter(|id| *id != 0).collect();
    ids.dedup();
    ids
}

/// Computes the rows of the first area by the pure steps and compares them, bit by bit; gives how many parameter sets were learnt.
///
/// Each parameter set is offered where the column says that it came into force; its values come from the identifier's own steps over
/// the same pairs and solutions.
pub fn retrace(configuration: &Configuration, text: &str, story: &Story) -> Result<u64, String> {
    let rows = rows(configuration, text);
    let mut pairs = pairs(configuration, &rows, story);
    let mut estimator = lane::estimator(configuration, 0);
    let mut identifier = lane::identifier(configuration, 0);
    let mut known: HashMap<u64, FlexureParams> = HashMap::new();
    let mut file = SolutionFile::new(Vec::new()).unwrap();
    let mut in_force = 0;
    let mut checkpoints: Vec<Solution> = Vec::new();
    for (number, row) in &rows {
        let pair = pairs.remove(number).ok_or(format!("no pair {number} comes of the samples"))?;
        if story.estimator == Some(*number) {
            (estimator, in_force) = (lane::estimator(configuration, 0), 0);
            if let Some(back) = story.checkpoint {
                let last = checkpoints.iter().rev().nth(back).ok_or("there is no such checkpoint")?;
                estimator.resume(last);
            }
        }
        if story.identifier == Some(*number) {
            identifier = lane::identifier(configuration, 0);
        }
        if row.params_id != in_force {
            let set = known.get(&row.params_id).ok_or(format!("no set {} comes of the solutions", row.params_id))?;
            estimator.offer(*set);
            in_force = row.params_id;
        }
        let solution = estimator.step(&pair);
        file.write(&solution).unwrap();
        let since_ns = checkpoints.last().map_or(i64::MAX, |last| solution.header.time_ns - last.header.time_ns);
        if solution.is_valid() && since_ns >= CHECKPOINT_NS {
            checkpoints.push(solution);
        }
        known.extend(identifier.step(&pair, &solution).map(|set| (set.id, set)));
    }
    let again = String::from_utf8(file.finish().unwrap()).unwrap();
    first_difference(text, &again).map_or(Ok(known.len() as u64), Err)
}

/// The pairs that the synchroniser makes of the samples that were there.
///
/// A synchroniser that is started anew subscribes to one topic after the other, so that the main unit's samples may come to it before
/// the first of the sub unit, and before the first attitude. The rows tell: they say `gap`, and have no deck.
fn pairs(configuration: &Configuration, rows: &BTreeMap<u64, Row>, story: &Story) -> BTreeMap<u64, ImuPair> {
    let mut source = Source::open(configuration, 0).unwrap();
    let mut synchroniser = lane::synchroniser(configuration, 0);
    let mut pairs = BTreeMap::new();
    let (mut has_sub, mut has_attitude, mut first_missing) = (true, true, true);
    let mut batch = Batch::default();
    while source.next(&mut batch) {
        let number = batch.main.header.sequence;
        let row = rows.get(&number);
        if story.synchroniser == Some(number) {
            synchroniser = lane::synchroniser(configuration, 0);
            (has_sub, has_attitude) = (false, false);
        }
        has_sub |= row.is_some_and(|row| !row.gap);
        has_attitude |= row.is_some_and(|row| row.deck);
        let there = row.is_some() || story.missing == Missing::Pairs;
        if there {
            batch.attitude.iter().filter(|_| has_attitude).for_each(|attitude| synchroniser.attitude(attitude));
            synchroniser.main(&batch.main);
        }
        let but_one = story.missing == Missing::SamplesButOne && !there && first_missing;
        first_missing &= there;
        if has_sub && (there || but_one) {
            batch.sub.iter().for_each(|sample| synchroniser.sub(sample));
        }
        pairs.extend(std::iter::from_fn(|| synchroniser.pair()).map(|pair| (pair.header.sequence, pair)));
    }
    synchroniser.end();
    pairs.extend(std::iter::from_fn(|| synchroniser.pair()).map(|pair| (pair.header.sequence, pair)));
    pairs
}
