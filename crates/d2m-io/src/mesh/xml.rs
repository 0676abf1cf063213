//! XML documents: a tree by `roxmltree`, numbers read as doubles, faults with their lines.

use super::Fault;
use crate::text::excerpt;
use roxmltree::{Document, Node, ParsingOptions};

/// The document of a text. Type definitions (DTD), whose entities may grow without bounds, are refused.
pub(super) fn document(text: &str) -> Result<Document<'_>, Fault> {
    // A node takes some eighty bytes, and a text needs ten for one that says something.
    let nodes_limit = u32::try_from(text.len() / 8 + 1024).unwrap_or(u32::MAX);
    let options = ParsingOptions { allow_dtd: false, nodes_limit, ..ParsingOptions::default() };
    Document::parse_with_options(text, options)
        .map_err(|error| Fault::at_line(error.pos().row as usize, error.to_string()))
}

/// What is wrong at an element.
pub(super) fn fault(node: Node<'_, '_>, reason: impl AsRef<str>) -> Fault {
    let line = node.document().text_pos_at(node.range().start).row as usize;
    Fault::at_line(line, format!("<{}>: {}", node.tag_name().name(), reason.as_ref()))
}

/// The first child element of a name.
pub(super) fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    children(node, name).next()
}

/// All child elements of a name.
pub(super) fn children<'a, 'i>(node: Node<'a, 'i>, name: &str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(move |child| child.tag_name().name() == name)
}

/// An attribute that must be there.
pub(super) fn attribute<'a>(node: Node<'a, '_>, name: &str) -> Result<&'a str, Fault> {
    node.attribute(name).ok_or_else(|| fault(node, format!("the attribute {name} is missing")))
}

/// The words of an element's text.
pub(super) fn words<'a>(node: Node<'a, '_>) -> impl Iterator<Item = &'a str> {
    node.children().filter_map(|child| child.text()).flat_map(str::split_whitespace)
}

/// A finite number.
pub(super) fn number(node: Node<'_, '_>, word: &str) -> Result<f64, Fault> {
    match word.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(fault(node, format!("{} is not a finite number", excerpt(word)))),
        Err(_) => Err(fault(node, format!("{} is not a number", excerpt(word)))),
    }
}

/// The whole number in an attribute, which may be missing.
pub(super) fn whole<T: std::str::FromStr>(node: Node<'_, '_>, name: &str) -> Result<Option<T>, Fault> {
    let parse = |word: &str| {
        let not_whole = |_| fault(node, format!("{name} is {}, not a whole number in range", excerpt(word)));
        word.trim().parse().map_err(not_whole)
    };
    node.attribute(name).map(parse).transpose()
}

/// Exactly N numbers.
pub(super) fn numbers<'a, const N: usize>(
    node: Node<'_, '_>,
    words: impl Iterator<Item = &'a str>,
) -> Result<[f64; N], Fault> {
    let mut values = [0.0; N];
    let mut count = 0;
    for word in words {
        if let Some(slot) = values.get_mut(count) {
            *slot = number(node, word)?;
        }
        count += 1;
    }
    if count == N { Ok(values) } else { Err(fault(node, format!("{count} numbers instead of {N}"))) }
}
