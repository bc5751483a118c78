//! The layouts that other processes, and other languages, rely on. Whoever changes a line here changes the version in the
//! message's type name too.

use messages::*;
use std::mem::{offset_of, size_of};

macro_rules! layout {
    ($type:ty, $name:literal, $size:literal, $($field:ident @ $offset:literal),*) => {
        assert_eq!(<$type as Message>::TYPE_NAME, $name);
        assert_eq!(size_of::<$type>(), $size, "size of {}", $name);
        $(assert_eq!(offset_of!($type, $field), $offset, "{}.{}", $name, stringify!($field));)*
    };
}

#[test]
fn layouts_are_as_published() {
    assert_eq!(size_of::<Stamps>(), 48);
    assert_eq!(size_of::<Header>(), 80);
    layout!(ImuSample, "deckflex/ImuSample/1", 152, header @ 0, interval_ns @ 80, ordinal @ 88, dtheta @ 96, dvel @ 120, flags @ 144, unit @ 148);
    layout!(MainAttitude, "deckflex/MainAttitude/1", 136, q @ 80, sigma @ 112);
    layout!(ImuPair, "deckflex/ImuPair/1", 328, epoch @ 80, interval_ns @ 88, dtheta_m @ 96, dtheta_s @ 144, attitude_m @ 192,
        attitude_s @ 224, ins @ 256, ins_sigma @ 288, disturbance @ 312, area @ 320, flags @ 324);
    layout!(FlexureParams, "deckflex/FlexureParams/2", 328, id @ 80, window_begin_ns @ 88, effective_from_ns @ 96, mu @ 104,
        b @ 128, sigma @ 152, ln_sigma_sd @ 224, second_mu @ 248, second_sigma @ 296, points @ 320, area @ 324);
    layout!(Solution, "deckflex/Solution/3", 768, params_id @ 80, epoch @ 88, q @ 96, static_q @ 128, constant @ 160, phi @ 192,
        dynamic @ 216, rate @ 240, drift @ 264, scale @ 288, covariance @ 336, static_covariance @ 408, dynamic_covariance @ 480,
        registered @ 552, registered_sigma @ 584, delay @ 608, skew_sigma @ 632, range @ 640, deck @ 664, deck_sigma @ 696, nis @ 720,
        zero @ 728, area @ 752, valid @ 756, flags @ 760);
    layout!(StatePart, "deckflex/StatePart/1", 768, length @ 80, offset @ 88, area @ 96, bytes @ 104);
    layout!(StateWish, "deckflex/StateWish/1", 80, header @ 0);
    layout!(Truth, "deckflex/Truth/1", 208, q @ 80, static_q @ 112, dynamic @ 144, ship @ 168, area @ 200);
    layout!(LineHealth, "deckflex/LineHealth/3", 264, arrival_ns @ 80, device_ns @ 88, skew @ 96, sigma @ 112, good @ 120,
        overflow @ 200, opened @ 216, utc_offset_ns @ 224, utc_at_ns @ 232, by_device @ 240, unit @ 256, settled @ 260);
    layout!(Health, "deckflex/Health/2", 176, taken @ 80, late @ 136, stage @ 152, pid @ 168, alarms @ 172);
    layout!(OutputState, "deckflex/OutputState/2", 200, sent @ 80, zeroed @ 120, utc_offset_ns @ 128, delay_p50_ns @ 160, utc_source @ 184, open @ 196);
}

#[test]
fn flags_have_the_names_of_the_files() {
    assert_eq!((Flags::GAP | Flags::NEW_EPOCH).names(), "gap|new_epoch");
    assert_eq!(Flags::default().names(), "");
}

#[test]
fn codes_come_back() {
    for stage in [
        Stage::Simulate,
        Stage::Replay,
        Stage::Synchronise,
        Stage::Estimate,
        Stage::Identify,
        Stage::Acquire,
        Stage::Output,
        Stage::Record,
    ] {
        assert_eq!(Stage::from_code(stage as u32), Some(stage));
    }
    assert_eq!(State::from_code(99), None);
}
