//! UTC of a telegram: its date and time of validity, where the device has lately been told UTC. Without that the time is since the start
//! and the date means nothing.

use super::{TICK_NS, Telegram};

/// Ticks of a day.
const DAY: u32 = 864_000_000;
const DAY_NS: i64 = DAY as i64 * TICK_NS;
/// What the device was told may be so old, ticks: some seconds, since it is told once a second.
const FRESH: u32 = 50_000;

impl Telegram {
    /// UTC at the time of validity, ns since 1970; `None` where the telegram does not tell it.
    pub fn utc_ns(&self) -> Option<i64> {
        let told = self.utc.filter(|told| *told < DAY && self.time < DAY)?;
        let age = (self.time + DAY - told) % DAY;
        let [day, month, year] = self.date.filter(|_| age < FRESH)?;
        let days = days(i64::from(year), i64::from(month), i64::from(day))?;
        Some(days * DAY_NS + i64::from(self.time) * TICK_NS)
    }

    /// With the date, time and UTC of an instant, ns since 1970, told at the last whole second.
    pub fn at_utc(self, utc_ns: i64) -> Self {
        let time = (utc_ns.rem_euclid(DAY_NS) / TICK_NS) as u32;
        Self { date: Some(date(utc_ns.div_euclid(DAY_NS))), time, utc: Some(time - time % 10_000), ..self }
    }
}

/// Days since 1970 of a date of the Gregorian calendar; the year is taken to begin in March, so that the leap day is its last.
fn days(year: i64, month: i64, day: i64) -> Option<i64> {
    if !((1970..=2200).contains(&year) && (1..=12).contains(&month) && (1..=31).contains(&day)) {
        return None;
    }
    let year = if month > 2 { year } else { year - 1 };
    let of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    // 719468 days from March of the year 0 to 1970
    Some(365 * year + year / 4 - year / 100 + year / 400 + of_year - 719_468)
}

/// Day, month and year of a day since 1970.
fn date(since_1970: i64) -> [u16; 3] {
    let days = since_1970 + 719_468;
    let (era, of_era) = (days.div_euclid(146_097), days.rem_euclid(146_097));
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = (month_from_march + 2) % 12 + 1;
    let year = 400 * era + year_of_era + i64::from(month <= 2);
    [day as u16, month as u16, year as u16]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_come_back_and_are_those_of_the_calendar() {
        for (known, of) in [(0, [1, 1, 1970]), (11_016, [29, 2, 2000]), (17_969, [14, 3, 2019]), (47_541, [1, 3, 2100])]
        {
            assert_eq!(date(known), of);
            assert_eq!(days(of[2].into(), of[1].into(), of[0].into()), Some(known));
        }
        for day in 0..84_000 {
            let [d, m, y] = date(day);
            assert_eq!(days(y.into(), m.into(), d.into()), Some(day));
        }
    }

    #[test]
    fn without_fresh_utc_a_telegram_tells_none() {
        let told = Telegram::default().at_utc(1_552_578_298_353_500_000);
        assert_eq!(told.utc_ns(), Some(1_552_578_298_353_500_000));
        let stale = |telegram: Telegram| assert_eq!(telegram.utc_ns(), None, "{telegram:?}");
        stale(Telegram { utc: None, ..told });
        stale(Telegram { date: None, ..told });
        stale(Telegram { date: Some([0, 0, 0]), ..told });
        stale(Telegram { time: told.time + FRESH, ..told });
        stale(Telegram { time: DAY, ..told });
        // over midnight: told at its last second, valid in the first of the next day
        let after = Telegram { time: 100, utc: Some(DAY - 10_000), ..told };
        assert!(after.utc_ns().is_some());
    }
}
