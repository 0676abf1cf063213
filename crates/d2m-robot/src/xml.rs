//! A thin reader over `roxmltree`: elements, their attributes as numbers, and faults with file and line.

use crate::RobotError;
use glam::DVec3;
use roxmltree::{Document, Error, Node, ParsingOptions};

/// A file that was parsed.
pub(crate) struct Xml<'a> {
    file: &'a str,
    document: Document<'a>,
    /// Where each line begins, so that no element counts them again.
    line_starts: Vec<usize>,
}

/// An element of it.
#[derive(Clone, Copy)]
pub(crate) struct Element<'a> {
    file: &'a str,
    node: Node<'a, 'a>,
    line_starts: &'a [usize],
}

impl<'a> Xml<'a> {
    pub(crate) fn parse(file: &'a str, text: &'a str) -> Result<Self, RobotError> {
        // A mark of the order of bytes is no part of the text.
        let text = text.trim_start_matches('\u{feff}');
        let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
        let document = Document::parse_with_options(text, options).map_err(|error| {
            let hint = match &error {
                Error::UnknownNamespace(prefix, _) if prefix == "xacro" => {
                    ": this is a xacro file; expand it first"
                }
                _ => "",
            };
            RobotError::Xml { file: file.to_owned(), line: error.pos().row, reason: format!("{error}{hint}") }
        })?;
        let breaks = text.bytes().enumerate().filter(|&(_, byte)| byte == b'\n');
        let line_starts = core::iter::once(0).chain(breaks.map(|(at, _)| at + 1)).collect();
        Ok(Self { file, document, line_starts })
    }

    /// The outermost element, which has this name.
    pub(crate) fn root(&'a self, name: &str) -> Result<Element<'a>, RobotError> {
        let root =
            Element { file: self.file, node: self.document.root_element(), line_starts: &self.line_starts };
        if root.is(name) {
            Ok(root)
        } else {
            Err(root.fault(format!("<{}> where <{name}> is expected", root.node.tag_name().name())))
        }
    }
}

impl<'a> Element<'a> {
    pub(crate) fn is(self, name: &str) -> bool {
        self.node.is_element() && self.node.tag_name().name() == name
    }

    pub(crate) fn line(self) -> u32 {
        let at = self.node.range().start;
        self.line_starts.partition_point(|&start| start <= at) as u32
    }

    pub(crate) fn fault(self, reason: impl Into<String>) -> RobotError {
        RobotError::Xml { file: self.file.to_owned(), line: self.line(), reason: reason.into() }
    }

    /// The elements directly inside of this one that have a name. Those of the same name deeper down (joints in
    /// transmissions) are others.
    pub(crate) fn children(self, name: &'a str) -> impl Iterator<Item = Self> {
        let children = self.node.children().map(move |node| Self { node, ..self });
        children.filter(move |child| child.is(name))
    }

    /// All elements directly inside of this one.
    pub(crate) fn elements(self) -> impl Iterator<Item = Self> {
        self.node.children().filter(Node::is_element).map(move |node| Self { node, ..self })
    }

    /// This element and all inside of it, however deep.
    pub(crate) fn descendants(self) -> impl Iterator<Item = Self> {
        self.node.descendants().filter(Node::is_element).map(move |node| Self { node, ..self })
    }

    /// The element directly inside of this one that has a name, of which there is at most one.
    pub(crate) fn child(self, name: &'a str) -> Result<Option<Self>, RobotError> {
        let mut children = self.children(name);
        let first = children.next();
        match children.next() {
            None => Ok(first),
            Some(second) => Err(second.fault(format!("<{}> has a second <{name}>", self.name()))),
        }
    }

    pub(crate) fn name(self) -> &'a str {
        self.node.tag_name().name()
    }

    pub(crate) fn namespace(self) -> Option<&'a str> {
        self.node.tag_name().namespace()
    }

    pub(crate) fn attribute(self, key: &str) -> Option<&'a str> {
        self.node.attribute(key)
    }

    /// An attribute that has to be there and not be empty.
    pub(crate) fn needed(self, key: &str) -> Result<&'a str, RobotError> {
        match self.attribute(key).map(str::trim) {
            None => Err(self.fault(format!("<{}> has no {key}", self.name()))),
            Some("") => Err(self.fault(format!("the {key} of <{}> is empty", self.name()))),
            Some(value) => Ok(value),
        }
    }

    /// An attribute that is a finite number.
    pub(crate) fn number(self, key: &str) -> Result<Option<f64>, RobotError> {
        let Some(text) = self.attribute(key) else { return Ok(None) };
        self.finite(key, text.trim()).map(Some)
    }

    pub(crate) fn needed_number(self, key: &str) -> Result<f64, RobotError> {
        self.number(key)?.ok_or_else(|| self.fault(format!("<{}> has no {key}", self.name())))
    }

    /// A length that has to be above zero.
    pub(crate) fn length(self, key: &str) -> Result<f64, RobotError> {
        let length = self.needed_number(key)?;
        if length > 0.0 {
            Ok(length)
        } else {
            Err(self.fault(format!("the {key} of <{}> is {length:?}: it has to be above zero", self.name())))
        }
    }

    /// An attribute that is three finite numbers.
    pub(crate) fn vector(self, key: &str) -> Result<Option<DVec3>, RobotError> {
        let Some(text) = self.attribute(key) else { return Ok(None) };
        let words: Vec<&str> = text.split_whitespace().collect();
        let [x, y, z] = words[..] else {
            let found = d2m_io::excerpt(text);
            return Err(self.fault(format!("the {key} of <{}> is {found}, not three numbers", self.name())));
        };
        let number = |word| self.finite(key, word);
        Ok(Some(DVec3::new(number(x)?, number(y)?, number(z)?)))
    }

    fn finite(self, key: &str, word: &str) -> Result<f64, RobotError> {
        match word.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => {
                let found = d2m_io::excerpt(word);
                Err(self.fault(format!("the {key} of <{}> is {found}, not a finite number", self.name())))
            }
        }
    }
}
