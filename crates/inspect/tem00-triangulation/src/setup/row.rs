use super::{QuantityUnit, SetupDescription};

type Get = fn(&SetupDescription) -> f64;
type Field = fn(&mut SetupDescription) -> &mut f64;

/// Declaration of a quantity.
pub(super) struct Row {
    pub(super) section: &'static str,
    pub(super) key: &'static str,
    /// The meaning and the allowed values, as the page of set-up files has them.
    pub(super) page: &'static str,
    pub(super) get: Get,
    pub(super) field: Field,
    pub(super) unit: &'static QuantityUnit,
    /// The closed range of allowed values, in SI units, and its words.
    pub(super) range: fn(&SetupDescription) -> (f64, f64),
    pub(super) allowed: &'static str,
    /// The value without the key, as the page has it.
    pub(super) default: &'static str,
    /// An example of the value of a required key.
    pub(super) example: Option<&'static str>,
    /// True if the key is read together with keys of no quantity.
    pub(super) is_read_with_others: bool,
    /// Returns whether a written set-up has the key.
    pub(super) is_written: fn(&SetupDescription) -> bool,
    /// The comment next to the key in a written set-up.
    pub(super) note: &'static str,
    /// The place among the quantities that a search may vary.
    pub(super) design: Option<u8>,
}

impl Row {
    pub(super) const fn new((get, field): (Get, Field), unit: &'static QuantityUnit) -> Self {
        Self {
            section: "",
            key: "",
            page: "",
            get,
            field,
            unit,
            range: |_| (f64::MIN, f64::MAX),
            allowed: "finite",
            default: "`0`",
            example: None,
            is_read_with_others: false,
            is_written: |_| true,
            note: "",
            design: None,
        }
    }

    pub(super) const fn within(
        mut self,
        range: fn(&SetupDescription) -> (f64, f64),
        allowed: &'static str,
    ) -> Self {
        (self.range, self.allowed) = (range, allowed);
        self
    }

    pub(super) const fn required(mut self, example: &'static str) -> Self {
        (self.default, self.example) = ("required", Some(example));
        self
    }

    pub(super) const fn or(mut self, default: &'static str) -> Self {
        self.default = default;
        self
    }

    pub(super) const fn read_with_others(mut self) -> Self {
        self.is_read_with_others = true;
        self
    }

    pub(super) const fn written_if(mut self, is_written: fn(&SetupDescription) -> bool) -> Self {
        self.is_written = is_written;
        self
    }

    pub(super) const fn note(mut self, note: &'static str) -> Self {
        self.note = note;
        self
    }

    pub(super) const fn varied(mut self, place: u8) -> Self {
        self.design = Some(place);
        self
    }

    pub(super) const fn at(
        mut self,
        section: &'static str,
        key: &'static str,
        page: &'static str,
    ) -> Self {
        (self.section, self.key, self.page) = (section, key, page);
        self
    }
}
