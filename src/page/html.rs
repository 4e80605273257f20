//! HTML in which nothing that comes from a log can be markup: text goes in by [`Html::text`] only.

use chart::escaped;

/// A document that grows.
#[derive(Default)]
pub struct Html(String);

impl Html {
    /// Adds markup, which stands in the program.
    pub fn markup(&mut self, markup: &'static str) -> &mut Self {
        self.0.push_str(markup);
        self
    }

    /// Adds text, whatever is in it.
    pub fn text(&mut self, text: &str) -> &mut Self {
        self.0.push_str(&escaped(text));
        self
    }

    /// Adds an element with a text in it.
    pub fn element(&mut self, tag: &'static str, text: &str) -> &mut Self {
        self.open(tag).text(text).close(tag)
    }

    fn open(&mut self, tag: &'static str) -> &mut Self {
        self.markup("<").markup(tag).markup(">")
    }

    fn close(&mut self, tag: &'static str) -> &mut Self {
        self.markup("</").markup(tag).markup(">\n")
    }

    /// Adds a picture with what stands below it.
    pub fn figure(&mut self, page: &chart::Page, id: &str, caption: &str) {
        self.markup("<figure>\n<div class=\"wide\">\n");
        // Written by the chart, which escapes.
        self.0.push_str(&chart::svg(page, id));
        self.markup("</div>\n");
        if !caption.is_empty() {
            self.element("figcaption", caption);
        }
        self.markup("</figure>\n");
    }

    /// Adds a table.
    pub fn table(&mut self, head: &[&str], rows: &[Vec<String>]) {
        self.markup("<div class=\"wide\"><table>\n<thead><tr>");
        for name in head {
            self.markup("<th>").text(name).markup("</th>");
        }
        self.markup("</tr></thead>\n<tbody>\n");
        for row in rows {
            self.markup("<tr>");
            for cell in row {
                self.markup("<td>").text(cell).markup("</td>");
            }
            self.markup("</tr>\n");
        }
        self.markup("</tbody></table></div>\n");
    }

    /// Adds a list of names and what they are.
    pub fn facts(&mut self, facts: &[(String, String)]) {
        self.markup("<dl>\n");
        for (name, what) in facts {
            self.markup("<dt>").text(name).markup("</dt><dd>").text(what).markup("</dd>\n");
        }
        self.markup("</dl>\n");
    }

    /// The document.
    pub fn finish(self) -> String {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_is_text_becomes_markup() {
        let hostile = "<img src=x onerror=alert(1)>\"'&";
        let mut html = Html::default();
        html.element("p", hostile);
        html.table(&[hostile], &[vec![hostile.into()]]);
        html.facts(&[(hostile.into(), hostile.into())]);
        html.figure(&chart::Page::new(1.0, 1.0, hostile, hostile), hostile, hostile);
        let text = html.finish();
        assert!(!text.contains("<img") && !text.contains("\"'&"), "{text}");
        // A paragraph, a table's head and cell, name and fact, a picture's two names of ids, title and description
        // with theirs, and what stands below it.
        assert_eq!(text.matches("&lt;img").count(), 1 + 2 + 2 + 2 + 4 + 1, "{text}");
    }
}
