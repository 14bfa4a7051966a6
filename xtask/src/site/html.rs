//! One page: Markdown to HTML, its headings, links and searchable text.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};

use pulldown_cmark::{CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd, html};

/// A page of the site.
pub struct Page {
    pub title: String,
    /// Whether its first heading is of level 1 and has a text.
    pub has_title: bool,
    pub body: String,
    /// The identifiers of its headings.
    pub ids: BTreeSet<String>,
    pub links: Vec<Link>,
    sections: Vec<Section>,
}

/// A link or an image to a file of the repository.
pub struct Link {
    /// The page that has it, in the repository.
    pub page: PathBuf,
    /// The file, in the repository.
    pub target: PathBuf,
    pub heading: Option<String>,
}

/// A part of a page that search finds.
#[derive(Default)]
struct Section {
    id: String,
    title: String,
    text: String,
}

/// Where a file of the repository lies in the site.
pub fn target(path: &Path) -> PathBuf {
    match path.file_name().and_then(|name| name.to_str()) {
        Some("README.md") => path.with_file_name("index.html"),
        Some(name) if name.ends_with(".md") => path.with_extension("html"),
        _ => path.to_path_buf(),
    }
}

impl Page {
    /// `path`: of the file, in the repository.
    pub fn new(path: &Path, text: &str) -> Self {
        let mut page = Self {
            title: String::new(),
            has_title: false,
            body: String::new(),
            ids: BTreeSet::new(),
            links: Vec::new(),
            sections: vec![Section::default()],
        };
        let options = Options::ENABLE_TABLES | Options::ENABLE_STRIKETHROUGH | Options::ENABLE_TASKLISTS;
        let events: Vec<Event<'_>> = Parser::new_ext(text, options).collect();
        let mut out = Vec::new();
        let mut at = 0;
        while at < events.len() {
            at = page.add(path, &events, at, &mut out);
        }
        html::push_html(&mut page.body, out.into_iter());
        // A cell without a text heads nothing.
        page.body = page.body.replace("<th></th>", "<td></td>");
        let mut titles = page.sections.iter().map(|section| &section.title);
        page.title = titles.find(|title| !title.is_empty()).cloned().unwrap_or_default();
        page
    }

    /// Adds an event, or all events of an image or a block of HTML. Returns the place of the next event.
    fn add<'a>(&mut self, path: &Path, events: &[Event<'a>], at: usize, out: &mut Vec<Event<'a>>) -> usize {
        match &events[at] {
            Event::Start(Tag::Heading { level, classes, attrs, .. }) => {
                let title = text_until(events, at, |end| matches!(end, TagEnd::Heading(_)));
                if self.sections.len() == 1 {
                    self.has_title = *level == HeadingLevel::H1 && !title.trim().is_empty();
                }
                let id = self.new_id(&identifier(&title));
                self.sections.push(Section { id: id.clone(), title, text: String::new() });
                let id = Some(CowStr::from(id));
                out.push(Event::Start(Tag::Heading {
                    level: *level,
                    id,
                    classes: classes.clone(),
                    attrs: attrs.clone(),
                }));
            }
            Event::Start(Tag::Link { link_type, dest_url, title, id }) => {
                let dest_url = CowStr::from(self.rewritten(path, dest_url));
                out.push(Event::Start(Tag::Link {
                    link_type: *link_type,
                    dest_url,
                    title: title.clone(),
                    id: id.clone(),
                }));
            }
            Event::Start(Tag::Image { dest_url, .. }) => {
                let alt = text_until(events, at, |end| matches!(end, TagEnd::Image));
                out.push(Event::InlineHtml(self.picture(path, dest_url, &alt).into()));
                return end_of(events, at, |end| matches!(end, TagEnd::Image)) + 1;
            }
            Event::Start(Tag::HtmlBlock) => {
                let end = end_of(events, at, |end| matches!(end, TagEnd::HtmlBlock));
                let text: String = events[at..end]
                    .iter()
                    .filter_map(|event| match event {
                        Event::Html(text) => Some(text.as_ref()),
                        _ => None,
                    })
                    .collect();
                out.extend(html_block(path, &text).map(|html| Event::Html(html.into())));
                return end + 1;
            }
            other => {
                if let (Event::Text(words) | Event::Code(words), Some(section)) =
                    (other, self.sections.last_mut())
                {
                    section.text.push_str(words);
                    section.text.push(' ');
                }
                out.push(other.clone());
            }
        }
        at + 1
    }

    /// The identifier, with a number if the page has it already.
    fn new_id(&mut self, name: &str) -> String {
        let numbered = (1..).map(|number| format!("{name}-{number}"));
        let id = std::iter::once(name.to_owned())
            .chain(numbered)
            .find(|id| !self.ids.contains(id))
            .unwrap_or_default();
        self.ids.insert(id.clone());
        id
    }

    /// A link as it is in the site. Notes the link.
    fn rewritten(&mut self, path: &Path, link: &str) -> String {
        if is_elsewhere(link) {
            return link.to_owned();
        }
        let (file, heading) =
            link.split_once('#').map_or((link, None), |(file, heading)| (file, Some(heading)));
        let linked = path.parent().unwrap_or(Path::new("")).join(file);
        let linked = if file.is_empty() { path.to_path_buf() } else { without_dots(&linked) };
        self.links.push(Link {
            page: path.to_path_buf(),
            target: linked,
            heading: heading.map(str::to_owned),
        });
        let file = if file.ends_with(".md") {
            target(Path::new(file)).to_string_lossy().into_owned()
        } else {
            file.to_owned()
        };
        format!("{file}{}", heading.map(|heading| format!("#{heading}")).unwrap_or_default())
    }

    /// An image. The text of a figure can be selected, so a figure is an object; it has the colours of the
    /// page, light or dark.
    fn picture(&mut self, path: &Path, link: &str, alt: &str) -> String {
        let source = self.rewritten(path, link);
        let alt = alt.replace('&', "&amp;").replace('"', "&quot;").replace('<', "&lt;");
        if source.ends_with(".svg") {
            return format!(
                "<object class=\"figure\" type=\"image/svg+xml\" data=\"{source}\" role=\"img\" \
                 aria-label=\"{alt}\">{alt}</object>"
            );
        }
        format!("<img src=\"{source}\" alt=\"{alt}\">")
    }
}

/// A block of HTML as the site has it: comments vanish, `<!-- interactive: NAME -->` becomes the place of an
/// interactive figure, and `<!-- viewer: STATE | CAPTION -->` the viewer with its sample in that state.
fn html_block(page: &Path, text: &str) -> Option<String> {
    let comment = text.trim().strip_prefix("<!--").and_then(|rest| rest.strip_suffix("-->"));
    let Some(comment) = comment.map(str::trim) else { return Some(text.to_owned()) };
    if let Some(name) = comment.strip_prefix("interactive: ") {
        return Some(format!("<div class=\"interactive\" data-figure=\"{}\"></div>\n", name.trim()));
    }
    let (state, caption) = comment.strip_prefix("viewer: ")?.split_once('|')?;
    Some(viewer(page, state.trim(), caption.trim()))
}

/// The viewer in a frame, with a link to it.
fn viewer(page: &Path, state: &str, caption: &str) -> String {
    let base = "../".repeat(page.components().count() - 1);
    // An empty fragment would scroll the page to the frame.
    let fragment = if state.is_empty() { String::new() } else { format!("#{state}") };
    let (address, caption) = (escaped(&format!("{base}viewer/index.html{fragment}")), escaped(caption));
    format!(
        "<figure class=\"viewer\">\n<iframe src=\"{address}\" title=\"The viewer\" \
         loading=\"lazy\"></iframe>\n\
         <figcaption>{caption} <a href=\"{address}\">The whole viewer</a></figcaption>\n</figure>\n"
    )
}

/// A text in HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

fn end_of(events: &[Event<'_>], from: usize, is_end: impl Fn(&TagEnd) -> bool) -> usize {
    let end = events[from..].iter().position(|event| matches!(event, Event::End(end) if is_end(end)));
    from + end.unwrap_or(events.len() - from - 1)
}

fn text_until(events: &[Event<'_>], from: usize, is_end: impl Fn(&TagEnd) -> bool) -> String {
    let words = events[from..end_of(events, from, is_end)].iter().filter_map(|event| match event {
        Event::Text(words) | Event::Code(words) => Some(words.as_ref()),
        Event::SoftBreak => Some(" "),
        _ => None,
    });
    words.collect()
}

/// A script that sets `searchIndex`: path, title of the page, identifier, title and text of every section.
pub fn search_index(pages: &BTreeMap<PathBuf, Page>) -> String {
    let sections = pages.iter().flat_map(|(path, page)| {
        let target = target(path).to_string_lossy().into_owned();
        let found = page.sections.iter().filter(|section| !section.text.trim().is_empty());
        found.map(move |section| {
            serde_json::json!([target, page.title, section.id, section.title, section.text.trim()])
        })
    });
    let sections: Vec<serde_json::Value> = sections.collect();
    format!("globalThis.searchIndex = {};\n", serde_json::Value::from(sections))
}

/// The identifier that GitHub gives a heading: lower case, spaces as hyphens, no other punctuation.
fn identifier(heading: &str) -> String {
    let kept = |letter: &char| letter.is_alphanumeric() || matches!(letter, ' ' | '-' | '_');
    heading
        .to_lowercase()
        .chars()
        .filter(kept)
        .map(|letter| if letter == ' ' { '-' } else { letter })
        .collect()
}

fn is_elsewhere(link: &str) -> bool {
    link.contains("://") || link.starts_with("mailto:")
}

/// The path with `..` resolved by its words alone.
fn without_dots(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                plain.pop();
            }
            Component::CurDir => {}
            other => plain.push(other),
        }
    }
    plain
}
