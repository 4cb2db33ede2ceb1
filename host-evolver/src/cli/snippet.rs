//! The line of a file that an error is about, with the place marked.

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use grn_input::InputError;
use std::error::Error;

/// The line that an error, or one that it comes from, is about; none if that is unknown.
pub fn of(error: &(dyn Error + 'static)) -> Option<String> {
    let mut link = Some(error);
    while let Some(error) = link {
        if let Some(place) = error.downcast_ref::<InputError>().and_then(InputError::place) {
            let start = place.text.char_indices().nth(place.column - 1).map_or(place.text.len(), |(at, _)| at);
            let mark = AnnotationKind::Primary.span(start..start + place.length);
            let snippet = Snippet::source(&place.text).line_start(place.line).annotation(mark);
            return Some(Renderer::plain().render(&[Group::with_level(Level::ERROR).element(snippet)]));
        }
        link = error.source();
    }
    None
}
