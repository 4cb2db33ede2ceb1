//! A light check that a document is well-formed, for the tests of the figures.

/// What a document holds.
pub(crate) struct Document {
    /// Every start tag as written, in order.
    pub tags: Vec<String>,
    /// The text of each `text` or `title` element, unescaped.
    pub texts: Vec<String>,
}

impl Document {
    pub fn count(&self, part: &str) -> usize {
        self.tags.iter().filter(|tag| tag.contains(part)).count()
    }

    pub fn says(&self, words: &str) -> bool {
        self.texts.iter().any(|text| text == words)
    }
}

/// Reads a document; panics where it is not well-formed or holds a number that is none.
pub(crate) fn read(svg: &str) -> Document {
    for bad in ["NaN", "inf\"", "inf ", "-inf"] {
        assert!(!svg.contains(bad), "the document holds {bad}");
    }
    assert!(svg.starts_with("<?xml"));
    let mut rest = &svg[svg.find("?>").unwrap() + 2..];
    let (mut stack, mut document) = (Vec::<String>::new(), Document { tags: vec![], texts: vec![] });
    let mut roots = 0;
    while let Some(open) = rest.find('<') {
        let words = unescape(&rest[..open]);
        if stack.iter().any(|tag| tag == "text" || tag == "title") {
            document.texts.last_mut().unwrap().push_str(&words);
        } else {
            assert_eq!(words.trim(), "", "text outside text elements");
        }
        let end = open + rest[open..].find('>').expect("a tag without end");
        let tag = &rest[open + 1..end];
        assert!(!tag.contains('<'), "a bare < in {tag}");
        assert_eq!(tag.matches('"').count() % 2, 0, "quotes in {tag}");
        if let Some(name) = tag.strip_prefix('/') {
            let opened = stack.pop().expect("an end tag without start");
            assert_eq!(name, opened);
            if name == "text" || name == "title" {
                let text = document.texts.last_mut().unwrap();
                *text = text.trim_matches('\n').to_owned();
            }
        } else {
            let name = tag.split([' ', '/']).next().unwrap().to_owned();
            document.tags.push(tag.to_owned());
            if stack.is_empty() {
                roots += 1;
            }
            if name == "text" || name == "title" {
                document.texts.push(String::new());
            }
            if !tag.ends_with('/') {
                stack.push(name);
            }
        }
        rest = &rest[end + 1..];
    }
    assert_eq!(rest.trim(), "");
    assert!(stack.is_empty(), "left open: {stack:?}");
    assert_eq!(roots, 1);
    document
}

fn unescape(text: &str) -> String {
    let mut at = 0;
    while let Some(amp) = text[at..].find('&') {
        let known = ["&amp;", "&lt;", "&gt;", "&quot;"].iter().any(|e| text[at + amp..].starts_with(e));
        assert!(known, "a bare & in {text}");
        at += amp + 1;
    }
    text.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&")
}
