//! What an SRDF file says of collisions.

use crate::RobotError;
use crate::xml::Xml;
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// Pairs of links whose collisions are not checked, as an SRDF file states them.
///
/// ```
/// let srdf = d2m_robot::Srdf::parse("arm.srdf", r#"<robot name="arm">
///     <disable_collisions link1="base" link2="hand" reason="Never"/></robot>"#)?;
/// assert_eq!((srdf.robot(), srdf.disabled_pairs()[0]), (Some("arm"), ["base", "hand"]));
/// # Ok::<(), d2m_robot::RobotError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Srdf {
    file: String,
    robot: Option<String>,
    text: String,
    disabled: Vec<LinkPair>,
    disabled_links: Vec<LinkName>,
    enabled: Vec<LinkPair>,
    partners: Partners,
}

/// The same by links: with whom each is left out, and with whom it is taken in again.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct Partners {
    disabled: HashMap<String, HashSet<String>>,
    enabled: HashMap<String, HashSet<String>>,
    left_out: HashSet<String>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct LinkPair {
    links: [String; 2],
    line: u32,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct LinkName {
    link: String,
    line: u32,
}

impl Srdf {
    /// Reads a file.
    ///
    /// # Errors
    /// A file that cannot be read, or as [`Srdf::parse`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, RobotError> {
        let file = path.as_ref().display().to_string();
        let text = crate::packages::read_text(path.as_ref())?;
        Self::parse(&file, &text)
    }

    /// From the text of a file; its name is for messages.
    ///
    /// # Errors
    /// Text that is no XML, another outermost element than `<robot>`, or an element without its links, with the line.
    pub fn parse(file: &str, text: &str) -> Result<Self, RobotError> {
        let xml = Xml::parse(file, text)?;
        let root = xml.root("robot")?;
        let pairs = |name: &'static str| {
            root.children(name)
                .map(|element| {
                    let links = [element.needed("link1")?.to_owned(), element.needed("link2")?.to_owned()];
                    Ok(LinkPair { links, line: element.line() })
                })
                .collect::<Result<Vec<_>, RobotError>>()
        };
        let disabled_links = root
            .children("disable_default_collisions")
            .map(|element| Ok(LinkName { link: element.needed("link")?.to_owned(), line: element.line() }))
            .collect::<Result<Vec<_>, RobotError>>()?;
        let (disabled, enabled) = (pairs("disable_collisions")?, pairs("enable_collisions")?);
        let partners = Partners {
            disabled: by_link(&disabled),
            enabled: by_link(&enabled),
            left_out: disabled_links.iter().map(|of: &LinkName| of.link.clone()).collect(),
        };
        let robot = root.attribute("name").map(str::to_owned);
        Ok(Self {
            file: file.to_owned(),
            robot,
            text: text.to_owned(),
            disabled,
            disabled_links,
            enabled,
            partners,
        })
    }

    /// The file that it was read from.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The robot that it is of, if it names one.
    pub fn robot(&self) -> Option<&str> {
        self.robot.as_deref()
    }

    /// The text of the file.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The pairs that `<disable_collisions>` names, in the order of the file.
    pub fn disabled_pairs(&self) -> Vec<[&str; 2]> {
        self.disabled.iter().map(|pair| [pair.links[0].as_str(), pair.links[1].as_str()]).collect()
    }

    /// Is this pair left out? By `<disable_collisions>`, or by `<disable_default_collisions>` of one of its links, unless
    /// `<enable_collisions>` takes it in again.
    pub fn disables(&self, a: &str, b: &str) -> bool {
        let Partners { disabled, enabled, left_out } = &self.partners;
        let holds =
            |pairs: &HashMap<String, HashSet<String>>| pairs.get(a).is_some_and(|with| with.contains(b));
        holds(disabled) || ((left_out.contains(a) || left_out.contains(b)) && !holds(enabled))
    }

    /// The first link that is named here and is not among those of the robot, as a warning.
    pub fn find_unknown_links(&self, is_link: impl Fn(&str) -> bool) -> Vec<String> {
        let pairs = self.disabled.iter().chain(&self.enabled);
        let named = pairs.flat_map(|pair| pair.links.iter().map(move |link| (link, pair.line)));
        let named = named.chain(self.disabled_links.iter().map(|of| (&of.link, of.line)));
        named
            .filter(|(link, _)| !is_link(link))
            .map(|(link, line)| format!("{}, line {line}: the robot has no link {link:?}", self.file))
            .collect()
    }
}

/// Each link of the pairs with its partners, both ways.
fn by_link(pairs: &[LinkPair]) -> HashMap<String, HashSet<String>> {
    let mut all: HashMap<String, HashSet<String>> = HashMap::new();
    for LinkPair { links: [a, b], .. } in pairs {
        all.entry(a.clone()).or_default().insert(b.clone());
        all.entry(b.clone()).or_default().insert(a.clone());
    }
    all
}
