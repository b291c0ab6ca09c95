//! Elements of XML.

use tem00_report::report::escaped;

/// An element with attributes, and text or further elements in it.
pub(super) struct Element {
    name: &'static str,
    attributes: Vec<(&'static str, String)>,
    content: Content,
}

enum Content {
    Text(String),
    Elements(Vec<Element>),
}

impl Element {
    pub(super) fn new(name: &'static str, elements: impl IntoIterator<Item = Self>) -> Self {
        Self {
            name,
            attributes: Vec::new(),
            content: Content::Elements(elements.into_iter().collect()),
        }
    }

    pub(super) fn text(name: &'static str, text: impl ToString) -> Self {
        Self {
            name,
            attributes: Vec::new(),
            content: Content::Text(text.to_string()),
        }
    }

    pub(super) fn with_attribute(mut self, name: &'static str, value: &str) -> Self {
        self.attributes.push((name, value.to_owned()));
        self
    }

    /// Returns a document whose root is this element.
    pub(super) fn document(&self) -> String {
        let mut out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned();
        self.write(&mut out, "");
        out
    }

    fn write(&self, out: &mut String, indent: &str) {
        let name = self.name;
        out.push_str(&format!("{indent}<{name}"));
        for (attribute, value) in &self.attributes {
            out.push_str(&format!(" {attribute}=\"{}\"", escaped(value)));
        }
        match &self.content {
            Content::Text(text) => out.push_str(&format!(">{}</{name}>\n", escaped(text))),
            Content::Elements(elements) => {
                out.push_str(">\n");
                let deeper = format!("{indent}  ");
                elements.iter().for_each(|inner| inner.write(out, &deeper));
                out.push_str(&format!("{indent}</{name}>\n"));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_and_attributes_are_escaped() {
        let inner = Element::text("b", "1 < 2 & \u{1}").with_attribute("lang", "\"en\"");
        assert_eq!(
            Element::new("a", [inner]).document(),
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<a>\n  \
             <b lang=\"&quot;en&quot;\">1 &lt; 2 &amp; \u{fffd}</b>\n</a>\n"
        );
    }
}
