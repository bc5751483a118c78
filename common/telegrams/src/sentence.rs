//! NMEA 0183 sentences.

use crate::{Attitude, Report, Talker, time_of_day};
use frames::unit::DEGREE;
use std::fmt::{self, Write};

/// A sentence, or two that belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sentence {
    /// Heading: `$--HDT,191.94,T*hh`.
    Hdt,
    /// Rate of turn in degrees a minute, positive to starboard: `$--ROT,31.61,A*hh`.
    Rot,
    /// `$PASHR,hhmmss.sss,heading,T,roll,pitch,heave,sigma of roll,of pitch,of heading,quality,status*hh`, in degrees, roll with the
    /// port side up, pitch with the bow up; the heave is not known and stays empty, the quality is 1 when valid and 0 when not.
    Pashr,
    /// Teledyne RDI: `$PRDID,pitch,roll,heading*hh`, pitch with the bow up, roll with the port side up.
    Prdid,
    /// iXblue: `$PHTRO,pitch,M or P,roll,B or T*hh` without signs: `M` bow up, `P` bow down, `B` port side down, `T` port side up.
    Phtro,
    /// Deformation, `$--XDR` with the transducers `DEFX`, `DEFY`, `DEFZ`, then half its 95 % range with `RNGX`, `RNGY`, `RNGZ`: degrees
    /// about the main unit's axes to starboard, to the bow and up, five decimals. Where the deformation is told from a zero, that zero
    /// follows in the same way with `ZERX`, `ZERY`, `ZERZ`; it is in force whether the deformation is valid or not.
    Xdr,
}

/// How sentences are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Of all sentences but makers' own.
    pub talker: Talker,
    /// Decimals of angles in degrees and of the rate of turn; sigmas have three and deformations five in any case.
    pub decimals: usize,
}

/// What stands between `$` and `*`; its numbers are [`rounded`] first, so none is longer than its field.
type Body<'a> = &'a mut dyn Write;

impl Sentence {
    /// All of them, in the order of the tables.
    pub const ALL: [Self; 6] = [Self::Hdt, Self::Rot, Self::Pashr, Self::Prdid, Self::Phtro, Self::Xdr];

    /// The name in configurations.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hdt => "HDT",
            Self::Rot => "ROT",
            Self::Pashr => "PASHR",
            Self::Prdid => "PRDID",
            Self::Phtro => "PHTRO",
            Self::Xdr => "XDR",
        }
    }

    /// The most bytes that it takes with so many decimals, where a zero is in force or not.
    pub fn longest(self, decimals: usize, zeroed: bool) -> usize {
        match self {
            Self::Hdt => 18 + decimals,
            Self::Rot => 20 + decimals,
            Self::Pashr => 67 + 3 * decimals,
            Self::Prdid => 28 + 3 * decimals,
            Self::Phtro => 25 + 2 * decimals,
            Self::Xdr => 71 + 68 + if zeroed { 71 } else { 0 },
        }
    }

    /// Appends it to a text, with check sum and line end.
    pub fn write(self, report: &Report, style: &Style, text: &mut String) {
        let Style { talker, decimals } = *style;
        let attitude = report.attitude.as_ref();
        match self {
            Self::Hdt => framed(text, |b| hdt(b, talker, attitude, decimals)),
            Self::Rot => framed(text, |b| rot(b, talker, attitude, decimals)),
            Self::Pashr => framed(text, |b| pashr(b, report, decimals)),
            Self::Prdid => framed(text, |b| prdid(b, attitude, decimals)),
            Self::Phtro => framed(text, |b| phtro(b, attitude, decimals)),
            Self::Xdr => {
                let angles = report.deformation.map(|deformation| deformation.angles);
                let range = report.deformation.map(|deformation| deformation.range);
                framed(text, |b| xdr(b, talker, "DEF", angles));
                framed(text, |b| xdr(b, talker, "RNG", range));
                if let Some(zero) = report.zero {
                    framed(text, |b| xdr(b, talker, "ZER", Some(zero)));
                }
            }
        }
    }
}

/// Puts a body between `$` and its check sum: all characters between `$` and `*`, joined by exclusive or.
fn framed(text: &mut String, body: impl FnOnce(Body) -> fmt::Result) {
    text.push('$');
    let begin = text.len();
    // writing to a text cannot fail
    let _ = body(text);
    let sum = text.as_bytes()[begin..].iter().fold(0, |sum, byte| sum ^ byte);
    let _ = write!(text, "*{sum:02X}\r\n");
}

/// Rounds to so many decimals, without a minus at zero, and keeps what no field has room for at the field's end.
fn rounded(value: f64, decimals: usize, end: f64) -> f64 {
    let scale = 10f64.powi(decimals as i32);
    ((value.clamp(-end, end) * scale).round() / scale) + 0.0
}

/// A heading in degrees that never reads 360.
fn heading(attitude: &Attitude, decimals: usize) -> f64 {
    let degrees = rounded(attitude.angles.heading / DEGREE, decimals, 720.0);
    if degrees >= 360.0 { degrees - 360.0 } else { degrees }
}

fn angle(radians: f64, decimals: usize) -> f64 {
    rounded(radians / DEGREE, decimals, 180.0)
}

fn hdt(b: Body, talker: Talker, attitude: Option<&Attitude>, decimals: usize) -> fmt::Result {
    let [first, second] = talker.letters();
    match attitude {
        Some(attitude) => write!(b, "{first}{second}HDT,{:.decimals$},T", heading(attitude, decimals)),
        None => write!(b, "{first}{second}HDT,,T"),
    }
}

fn rot(b: Body, talker: Talker, attitude: Option<&Attitude>, decimals: usize) -> fmt::Result {
    let [first, second] = talker.letters();
    match attitude {
        Some(attitude) => {
            let a_minute = rounded(attitude.rate.heading / DEGREE * 60.0, decimals, 9999.0);
            write!(b, "{first}{second}ROT,{a_minute:.decimals$},A")
        }
        None => write!(b, "{first}{second}ROT,,V"),
    }
}

fn pashr(b: Body, report: &Report, decimals: usize) -> fmt::Result {
    let Some(attitude) = &report.attitude else { return b.write_str("PASHR,,,T,,,,,,,0,1") };
    let (angles, sigma) = (&attitude.angles, &attitude.sigma);
    let (unsigned, signed) = (4 + decimals, 5 + decimals);
    write!(b, "PASHR,{},{:0unsigned$.decimals$},T", time_of_day(report.utc_ns), heading(attitude, decimals))?;
    for value in [angles.roll, angles.pitch] {
        write!(b, ",{:+0signed$.decimals$}", angle(value, decimals))?;
    }
    b.write_char(',')?;
    for value in [sigma.roll, sigma.pitch, sigma.heading] {
        // up, not to the nearest: a sigma that reads as zero promises too much
        write!(b, ",{:.3}", ((value / DEGREE * 1e3).ceil() / 1e3).min(99.999))?;
    }
    b.write_str(",1,1")
}

fn prdid(b: Body, attitude: Option<&Attitude>, decimals: usize) -> fmt::Result {
    let Some(attitude) = attitude else { return b.write_str("PRDID,,,") };
    let (unsigned, signed) = (4 + decimals, 5 + decimals);
    let (pitch, roll) = (angle(attitude.angles.pitch, decimals), angle(attitude.angles.roll, decimals));
    write!(b, "PRDID,{pitch:+0signed$.decimals$},{roll:+0signed$.decimals$}")?;
    write!(b, ",{:0unsigned$.decimals$}", heading(attitude, decimals))
}

fn phtro(b: Body, attitude: Option<&Attitude>, decimals: usize) -> fmt::Result {
    let Some(attitude) = attitude else { return b.write_str("PHTRO,,,,") };
    let (pitch, roll) = (angle(attitude.angles.pitch, decimals), angle(attitude.angles.roll, decimals));
    let bow = if pitch < 0.0 { 'P' } else { 'M' };
    let port = if roll < 0.0 { 'B' } else { 'T' };
    write!(b, "PHTRO,{:.decimals$},{bow},{:.decimals$},{port}", pitch.abs(), roll.abs())
}

fn xdr(b: Body, talker: Talker, name: &str, values: Option<[f64; 3]>) -> fmt::Result {
    let [first, second] = talker.letters();
    write!(b, "{first}{second}XDR")?;
    for (i, axis) in ['X', 'Y', 'Z'].into_iter().enumerate() {
        match values {
            Some(values) => write!(b, ",A,{:.5},D,{name}{axis}", rounded(values[i] / DEGREE, 5, 180.0))?,
            None => write!(b, ",A,,D,{name}{axis}")?,
        }
    }
    Ok(())
}
