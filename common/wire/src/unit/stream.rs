//! The frames of whichever device it is, as readings.

use super::Complaint;
use crate::framer::{Counts, Framer};
use crate::reading::Reading;
use crate::stim300::GyroUnit;
use crate::{Device, Rotation, kvh, stdbin, stim300};

#[derive(Debug)]
enum Frames {
    Kvh(Framer<kvh::Kvh>),
    Stdbin(Framer<stdbin::Stdbin>),
    Stim300(Framer<stim300::Stim300>),
}

/// The stream of a device.
#[derive(Debug)]
pub(super) struct Stream {
    device: Device,
    frames: Frames,
}

/// What a frame tells.
#[derive(Debug)]
pub(super) enum Told {
    Sample(Reading),
    Doubt(Complaint),
    Other,
}

impl Stream {
    pub fn new(device: Device) -> Self {
        let frames = match device {
            Device::Kvh { .. } => Frames::Kvh(Framer::default()),
            Device::Stdbin => Frames::Stdbin(Framer::default()),
            Device::Stim300 { .. } => Frames::Stim300(Framer::default()),
        };
        Self { device, frames }
    }

    pub fn push(&mut self, bytes: &[u8]) {
        match &mut self.frames {
            Frames::Kvh(framer) => framer.push(bytes),
            Frames::Stdbin(framer) => framer.push(bytes),
            Frames::Stim300(framer) => framer.push(bytes),
        }
    }

    pub fn counts(&self) -> Counts {
        match &self.frames {
            Frames::Kvh(framer) => framer.counts(),
            Frames::Stdbin(framer) => framer.counts(),
            Frames::Stim300(framer) => framer.counts(),
        }
    }

    pub fn next_frame(&mut self, interval_ns: i64) -> Option<Told> {
        Some(match (&mut self.frames, self.device) {
            (Frames::Kvh(framer), Device::Kvh { rotation, angle }) => match framer.next_frame()? {
                kvh::Frame::Inertial(frame) => Told::Sample(Reading::of_kvh(&frame, rotation, angle, interval_ns)),
                kvh::Frame::BuiltInTest { .. } => Told::Other,
            },
            (Frames::Stdbin(framer), _) => match framer.next_frame()? {
                stdbin::Frame::Telegram(telegram) => Told::Sample(Reading::of_stdbin(&telegram, interval_ns)),
                stdbin::Frame::Answer => Told::Other,
            },
            (Frames::Stim300(framer), Device::Stim300 { rotation, force_exponent }) => match framer.next_frame()? {
                stim300::Frame::Sample(frame) => {
                    Told::Sample(Reading::of_stim300(&frame, rotation, force_exponent, interval_ns))
                }
                stim300::Frame::Configuration(said) => doubt(&said, rotation, force_exponent),
                stim300::Frame::Other => Told::Other,
            },
            // a framer is made for its device
            (Frames::Kvh(_) | Frames::Stim300(_), _) => return None,
        })
    }
}

fn doubt(said: &stim300::Configuration, rotation: Rotation, force_exponent: i32) -> Told {
    let fits = match said.gyro_unit {
        GyroUnit::Rate | GyroUnit::Average => rotation == Rotation::Rate,
        GyroUnit::Increment => rotation == Rotation::Delta,
        GyroUnit::Integrated | GyroUnit::Unknown(_) => false,
    };
    match said.range_g {
        _ if !fits => Told::Doubt(Complaint::GyroUnit),
        Some(range) if stim300::force_exponent(range) != Some(force_exponent) => Told::Doubt(Complaint::Range(range)),
        _ => Told::Other,
    }
}
