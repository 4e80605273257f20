//! The page as SVG: for a browser, a text, a printer.

use std::fmt::Write as _;

use crate::page::{Anchor, Colour, Mark, Page, Pen, Weight, Words};

/// Fonts of the same widths, the first one that the reader's machine has.
const FAMILY: &str = "Arimo, Arial, 'Liberation Sans', Helvetica, sans-serif";

/// The page as SVG. Ids in it begin with `id`: several may stand in one document.
pub fn svg(page: &Page, id: &str) -> String {
    let (width, height) = (number(page.width), number(page.height));
    let id = escaped(id);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         width=\"{width}\" height=\"{height}\" role=\"img\" aria-labelledby=\"{id}-t {id}-d\" \
         font-family=\"{FAMILY}\" fill=\"none\">\n<title id=\"{id}-t\">{}</title>\n\
         <desc id=\"{id}-d\">{}</desc>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n",
        escaped(&page.title),
        escaped(&page.description),
    );
    for mark in &page.marks {
        match mark {
            Mark::Line(points, pen) => {
                let d = path(points);
                let _ =
                    writeln!(text, "<path d=\"{d}\"{} stroke-linejoin=\"round\"/>", stroke(pen));
            }
            Mark::Area(points, colour, ink) => {
                let _ = write!(text, "<path d=\"{}Z\" fill=\"{}\"", path(points), hex(*colour));
                if *ink < 1.0 {
                    let _ = write!(text, " fill-opacity=\"{}\"", number(*ink));
                }
                text.push_str("/>\n");
            }
            Mark::Disc([x, y], radius, colour, edge) => {
                let _ = writeln!(
                    text,
                    "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\"{}/>",
                    number(*x),
                    number(*y),
                    number(*radius),
                    hex(*colour),
                    edge.as_ref().map_or_else(String::new, stroke)
                );
            }
            Mark::Words(words) => write_words(&mut text, words),
        }
    }
    text.push_str("</svg>\n");
    text
}

fn write_words(text: &mut String, words: &Words) {
    let Words { at: [x, y], size, weight, colour, anchor, .. } = words;
    let (x, y, size) = (number(*x), number(*y), number(*size));
    let _ =
        write!(text, "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" fill=\"{}\"", hex(*colour));
    text.push_str(match anchor {
        Anchor::Start => "",
        Anchor::Middle => " text-anchor=\"middle\"",
        Anchor::End => " text-anchor=\"end\"",
    });
    if *weight == Weight::Bold {
        text.push_str(" font-weight=\"bold\"");
    }
    let _ = writeln!(text, ">{}</text>", escaped(&words.text));
}

/// Letters that mean something in a document, written so that they do not; control characters, which no
/// document may hold, are left out.
pub fn escaped(words: &str) -> String {
    let mut text = String::with_capacity(words.len());
    for letter in words.chars() {
        match letter {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '>' => text.push_str("&gt;"),
            '"' => text.push_str("&quot;"),
            '\'' => text.push_str("&#39;"),
            '\n' | '\t' => text.push(' '),
            '\u{FFFE}' | '\u{FFFF}' => {}
            // Those that turn the direction of what comes after them.
            '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}' => {}
            letter if letter.is_control() => {}
            letter => text.push(letter),
        }
    }
    text
}

fn path(points: &[[f64; 2]]) -> String {
    let mut d = String::new();
    for (place, [x, y]) in points.iter().enumerate() {
        let command = if place == 0 { "M" } else { "L" };
        let _ = write!(d, "{command}{} {}", number(*x), number(*y));
    }
    d
}

fn stroke(pen: &Pen) -> String {
    let mut text =
        format!(" stroke=\"{}\" stroke-width=\"{}\"", hex(pen.colour), number(pen.width));
    if let Some([dash, gap]) = pen.dash.lengths() {
        let _ = write!(text, " stroke-dasharray=\"{} {}\"", number(dash), number(gap));
    }
    text
}

fn hex(Colour(red, green, blue): Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// To a hundredth, without needless zeros.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, written) in
            [(1.0, "1"), (0.125, "0.12"), (-0.001, "0"), (10.5, "10.5"), (100.0, "100")]
        {
            assert_eq!(number(value), written);
        }
    }

    #[test]
    fn nothing_in_a_text_is_markup() {
        assert_eq!(
            escaped("<script a='1' b=\"2\">&\u{0}\u{1b}[31m\u{202e}é"),
            "&lt;script a=&#39;1&#39; b=&quot;2&quot;&gt;&amp;[31mé"
        );
        let mut page = Page::new(10.0, 10.0, "</title><script>", "</desc>");
        page.words([1.0, 2.0], "</text><script>", 9.0, crate::page::INK, Anchor::Start);
        let text = svg(&page, "\"><script>");
        assert!(!text.contains("<script"), "{text}");
    }
}
