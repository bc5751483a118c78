//! The solution files: one CSV an area, the same bytes from the processes and from the offline loop.

use frames::{Main, Nav, Rot, Sub, Vec3, unit};
use messages::Solution;
use nalgebra::Matrix3;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

const HEADER: &str = "t_s,valid,phi_x_arcsec,phi_y_arcsec,phi_z_arcsec,sigma_x_arcsec,sigma_y_arcsec,sigma_z_arcsec,\
static_x_arcsec,static_y_arcsec,static_z_arcsec,q_w,q_x,q_y,q_z,delay_ms,delay_sigma_ms,roll_deg,pitch_deg,heading_deg,\
params_id,flags,range_x_arcsec,range_y_arcsec,range_z_arcsec,\
dynamic_sigma_x_arcsec,dynamic_sigma_y_arcsec,dynamic_sigma_z_arcsec";

/// Writes the solutions of one area.
pub struct SolutionFile<W: Write> {
    out: W,
}

impl SolutionFile<BufWriter<File>> {
    /// Creates `solution_<area>.csv` in a folder.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(folder: &Path, area: &str) -> io::Result<Self> {
        Self::new(BufWriter::new(File::create(path(folder, area))?))
    }
}

/// The file of an area.
pub fn path(folder: &Path, area: &str) -> PathBuf {
    folder.join(format!("solution_{area}.csv"))
}

impl<W: Write> SolutionFile<W> {
    /// Writes the heading.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn new(mut out: W) -> io::Result<Self> {
        writeln!(out, "{HEADER}")?;
        Ok(Self { out })
    }

    /// Writes one solution; unknown values stay empty, numbers are as short as they can be read back exactly.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn write(&mut self, solution: &Solution) -> io::Result<()> {
        let out = &mut self.out;
        let known = solution.q != [0.0; 4];
        write!(out, "{},{}", unit::seconds(solution.header.time_ns), solution.valid)?;
        let arcsec = |out: &mut W, v: [f64; 3]| match known {
            true => v.iter().try_for_each(|x| write!(out, ",{}", x / unit::ARCSEC)),
            false => out.write_all(b",,,"),
        };
        arcsec(out, solution.phi)?;
        arcsec(out, deviations(&solution.covariance))?;
        let phi = Vec3::<Main>::from(solution.phi);
        arcsec(out, Rot::<Main, Sub>::from_wxyz(solution.static_q).log_beside(phi).array())?;
        match known {
            true => solution.q.iter().try_for_each(|x| write!(out, ",{x}"))?,
            false => out.write_all(b",,,,")?,
        }
        match solution.delay_sigma > 0.0 {
            true => write!(out, ",{},{}", solution.delay / 1e-3, solution.delay_sigma / 1e-3)?,
            false => out.write_all(b",,")?,
        }
        if solution.deck == [0.0; 4] {
            out.write_all(b",,,")?;
        } else {
            let deck = Rot::<Nav, Sub>::from_wxyz(solution.deck).euler();
            for angle in [deck.roll, deck.pitch, deck.heading] {
                write!(out, ",{}", angle / unit::DEGREE)?;
            }
        }
        write!(out, ",{},{}", solution.params_id, solution.flags.names())?;
        arcsec(out, solution.range)?;
        // of the difference of the two rotation vectors as they stand in the file, which at a large angle is not the small turn itself
        let jacobian = phi.left_jacobian_inverse();
        let of_difference = jacobian * Matrix3::from_row_slice(&solution.dynamic_covariance) * jacobian.transpose();
        arcsec(out, of_difference.diagonal().map(f64::sqrt).into())?;
        writeln!(out)
    }

    /// Brings everything to the output.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn finish(mut self) -> io::Result<W> {
        self.out.flush()?;
        Ok(self.out)
    }
}

/// Standard deviations from a covariance.
pub fn deviations(covariance: &[f64; 9]) -> [f64; 3] {
    [covariance[0].sqrt(), covariance[4].sqrt(), covariance[8].sqrt()]
}
