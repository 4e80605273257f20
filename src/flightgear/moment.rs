//! When FlightGear's sun stands where.

/// A moment of universal time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moment {
    unix_s: u64,
}

impl Moment {
    /// From nanoseconds since 1970, as logs have it.
    pub fn of_unix_ns(text: &str) -> Option<Self> {
        Some(Self { unix_s: text.parse::<u64>().ok()? / 1_000_000_000 })
    }

    /// `2020:06:21:21:00:00`.
    pub fn date(self) -> String {
        let (days, second) = (self.unix_s / 86_400, self.unix_s % 86_400);
        // Years from March on, so that the leap day is the last of them.
        let shifted = days + 719_468;
        let (era, day_of_era) = (shifted / 146_097, shifted % 146_097);
        let year_of_era =
            (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
        let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
        let month_from_march = (5 * day_of_year + 2) / 153;
        let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
        let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
        let year = year_of_era + era * 400 + u64::from(month <= 2);
        let (hour, minute) = (second / 3600, second / 60 % 60);
        format!("{year:04}:{month:02}:{day:02}:{hour:02}:{minute:02}:{:02}", second % 60)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_of_day_is_that_of_the_log() {
        let date = |text: &str| Moment::of_unix_ns(text).map(Moment::date);
        assert_eq!(date("0"), Some("1970:01:01:00:00:00".into()));
        assert_eq!(date("1592773261000000000"), Some("2020:06:21:21:01:01".into()));
        assert_eq!(date("1709164799999999999"), Some("2024:02:28:23:59:59".into()));
        assert_eq!(date("1709164800000000000"), Some("2024:02:29:00:00:00".into()));
        assert_eq!(date("yesterday"), None);
    }
}
