//! The day on which a report was made.

use std::{
    env,
    time::{SystemTime, UNIX_EPOCH},
};

use tem00_report::failure::Failure;

/// Seconds since 1970 in place of the clock, so that a page is the same whenever it is made
/// (reproducible-builds.org, *`SOURCE_DATE_EPOCH` specification*).
const EPOCH: &str = "SOURCE_DATE_EPOCH";
const SECONDS: u64 = 86_400;

/// Returns the day of today in UTC, such as "2026-11-26".
///
/// # Errors
///
/// Returns a failure if `SOURCE_DATE_EPOCH` is set but is not a number of seconds.
pub(crate) fn today() -> Result<String, Failure> {
    let Some(stated) = env::var_os(EPOCH) else {
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        return Ok(day(now.map_or(0, |now| now.as_secs() / SECONDS)));
    };
    let stated = stated.to_string_lossy();
    match stated.parse::<u64>() {
        Ok(seconds) if seconds < LAST => Ok(day(seconds / SECONDS)),
        _ => Err(Failure::input(
            format!(
                "{EPOCH} must be a number of seconds since 1970, before the year 10000, got \
                 {stated}"
            ),
            "unset it to have the day of the clock",
        )),
    }
}

/// The first second of the year 10000.
const LAST: u64 = 253_402_300_800;

/// Returns the days of the months of a year in the Gregorian calendar.
pub(crate) fn month_lengths(year: u64) -> [u64; 12] {
    let is_leap = year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    let february = 28 + u64::from(is_leap);
    [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31]
}

/// Writes the day `days` days after 1970-01-01.
fn day(mut days: u64) -> String {
    for year in 1970.. {
        for (month, length) in (1..).zip(month_lengths(year)) {
            if days < length {
                return format!("{year:04}-{month:02}-{:02}", days + 1);
            }
            days -= length;
        }
    }
    String::new()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Those of `date --utc --date=@SECONDS +%F`.
    #[test]
    fn days_are_those_of_the_calendar() {
        for (seconds, expected) in [
            (0, "1970-01-01"),
            (951_782_399, "2000-02-28"),
            (951_782_400, "2000-02-29"),
            (951_868_800, "2000-03-01"),
            (1_735_689_599, "2024-12-31"),
            (1_795_651_200, "2026-11-26"),
            (4_107_542_400, "2100-03-01"),
            (LAST - 1, "9999-12-31"),
        ] {
            assert_eq!(day(seconds / SECONDS), expected);
        }
    }
}
