//! Ranges of frames and tasks.

/// A range of frames or tasks, counted from 0, with both ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IndexRange {
    pub first: u32,
    pub last: u32,
}

impl core::str::FromStr for IndexRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (first, last) = text.split_once("..").unwrap_or((text, text));
        match (first.parse(), last.parse()) {
            (Ok(first), Ok(last)) if first <= last => Ok(Self { first, last }),
            (Ok(_), Ok(_)) => Err("the first must not be after the last".into()),
            _ => {
                Err("must be a number, such as 3, or a range with both ends, such as 3..10".into())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_one_or_a_range() {
        let range = |text: &str| text.parse::<IndexRange>();
        assert_eq!(range("4"), Ok(IndexRange { first: 4, last: 4 }));
        assert_eq!(range("0..9"), Ok(IndexRange { first: 0, last: 9 }));
        for bad in [
            "",
            "..",
            "3..",
            "..3",
            "5..3",
            "-1",
            "1.5",
            "1..2..3",
            "99999999999",
        ] {
            assert!(range(bad).is_err(), "{bad} is no range");
        }
    }
}
