//! Pictures as pixels, by `resvg`, with fonts that come along: the same bytes on every machine, whatever is installed there.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};
use std::error::Error;
use std::fmt;
use std::sync::Arc;

const FONTS: [&[u8]; 4] = [
    include_bytes!("../fonts/Arimo-Regular.ttf"),
    include_bytes!("../fonts/Arimo-Bold.ttf"),
    include_bytes!("../fonts/Arimo-Italic.ttf"),
    include_bytes!("../fonts/Arimo-BoldItalic.ttf"),
];
const FAMILY: &str = "Arimo";

/// Why a document has no pixels.
#[derive(Debug)]
#[non_exhaustive]
pub enum PngError {
    /// It is no SVG document.
    Svg(resvg::usvg::Error),
    /// So many pixels across and down are more than memory has addresses for.
    Size(u32, u32),
    /// The pixels could not be encoded; the text is the encoder's own.
    Encoding(String),
}

impl fmt::Display for PngError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Svg(_) => write!(f, "the picture is no SVG document"),
            Self::Size(width, height) => write!(f, "a picture of {width} x {height} pixels is too large"),
            Self::Encoding(reason) => write!(f, "the picture cannot be encoded: {reason}"),
        }
    }
}

impl Error for PngError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Svg(error) => Some(error),
            Self::Size(..) | Self::Encoding(_) => None,
        }
    }
}

/// Renders a document of this crate with so many pixels an inch; journals ask for 300. The fonts hold Latin, Greek and
/// Cyrillic letters.
///
/// # Errors
/// No SVG document, or too many pixels.
pub fn png(svg: &str, pixels_per_inch: f32) -> Result<Vec<u8>, PngError> {
    let mut fonts = fontdb::Database::new();
    FONTS.iter().for_each(|font| fonts.load_font_data(font.to_vec()));
    fonts.set_sans_serif_family(FAMILY);
    let options =
        Options { dpi: pixels_per_inch, font_family: FAMILY.into(), fontdb: Arc::new(fonts), ..Options::default() };
    let tree = Tree::from_str(svg, &options).map_err(PngError::Svg)?;
    let size = tree.size().to_int_size();
    let (width, height) = (size.width(), size.height());
    let mut pixels = Pixmap::new(width, height).ok_or(PngError::Size(width, height))?;
    resvg::render(&tree, Transform::identity(), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| PngError::Encoding(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::{SyntaxTree, tree};

    fn size(png: &[u8]) -> (u32, u32) {
        let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
        (number(16), number(20))
    }

    #[test]
    fn text_is_drawn_without_a_font_of_the_system() {
        let leaf = |label: &str| tree(&SyntaxTree { label: label.into(), detail: None, children: Vec::new() });
        let (one, other) = (png(&leaf("x1"), 72.0).unwrap(), png(&leaf("y1"), 72.0).unwrap());
        assert!(one.starts_with(b"\x89PNG\r\n"));
        assert_eq!(size(&one), size(&png(&leaf("x1"), 72.0).unwrap()));
        let empty = png(&leaf("x1").replace("<text", "<desc").replace("</text", "</desc"), 72.0).unwrap();
        assert!(one != empty && other != empty, "the letters leave no pixel");
        let twice = size(&png(&leaf("x1"), 144.0).unwrap());
        assert!(twice.0.abs_diff(2 * size(&one).0) <= 1, "{twice:?}");
        assert!(matches!(png("no picture", 72.0), Err(PngError::Svg(_))));
    }

    #[test]
    fn the_fonts_have_all_letters_of_figures() {
        let mut fonts = fontdb::Database::new();
        FONTS.iter().for_each(|font| fonts.load_font_data(font.to_vec()));
        let without = |letter: &char| {
            // A letter that is missing is a box like that of a sign which no font has.
            let text = |letter: char| png(&document(letter), 72.0).unwrap();
            text(*letter) == text('\u{E000}')
        };
        let missing: Vec<char> = "θσαβ–−…·×≥≤°²fM".chars().filter(without).collect();
        assert_eq!((fonts.len(), missing), (4, Vec::new()));
    }

    fn document(letter: char) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"20pt\" height=\"20pt\" font-family=\"{}\">\
             <text x=\"2\" y=\"15\" font-size=\"12\">{letter}</text></svg>",
            crate::style::FONTS
        )
    }
}
