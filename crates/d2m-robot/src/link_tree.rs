//! How the links of a robot hang together.

use crate::RobotError;
use crate::urdf::Urdf;
use std::collections::HashMap;

/// Who carries whom, each link by one joint but the root.
pub(crate) struct LinkTree {
    /// Of each joint of the file: parent and child.
    pub(crate) ends: Vec<[usize; 2]>,
    /// The links, each after its parent.
    pub(crate) order: Vec<usize>,
}

impl LinkTree {
    pub(crate) fn new(file: &str, urdf: &Urdf) -> Result<Self, RobotError> {
        let robot_fault = |reason: String| RobotError::Robot { file: file.to_owned(), reason };
        let fault = |line: u32, reason: String| RobotError::Xml { file: file.to_owned(), line, reason };
        if urdf.links.is_empty() {
            return Err(robot_fault("the robot has no link".to_owned()));
        }
        let mut by_name = HashMap::new();
        for (index, link) in urdf.links.iter().enumerate() {
            if by_name.insert(link.name.as_str(), index).is_some() {
                return Err(fault(link.line, format!("a second link has the name {:?}", link.name)));
            }
        }
        let mut joint_names = HashMap::new();
        let mut carried_by: Vec<Option<usize>> = vec![None; urdf.links.len()];
        let mut ends = Vec::with_capacity(urdf.joints.len());
        for (index, joint) in urdf.joints.iter().enumerate() {
            let name = &joint.name;
            if joint_names.insert(name.as_str(), index).is_some() {
                return Err(fault(joint.line, format!("a second joint has the name {name:?}")));
            }
            let end = |side: &str, link: &str| {
                let reason = || format!("joint {name:?}: the {side} {link:?} is no link");
                by_name.get(link).copied().ok_or_else(|| fault(joint.line, reason()))
            };
            let [parent, child] = [end("parent", &joint.parent)?, end("child", &joint.child)?];
            if let Some(other) = carried_by[child].replace(index) {
                let other = &urdf.joints[other].name;
                let reason = format!("joints {other:?} and {name:?} both carry the link {:?}", joint.child);
                return Err(fault(joint.line, reason));
            }
            ends.push([parent, child]);
        }
        let roots: Vec<usize> = (0..urdf.links.len()).filter(|&link| carried_by[link].is_none()).collect();
        match roots[..] {
            [_] => {}
            [] => {
                return Err(robot_fault("every link is carried by another one: there is no root".to_owned()));
            }
            [first, second, ..] => {
                let [first, second] = [first, second].map(|link| &urdf.links[link].name);
                let reason = format!(
                    "{} links are carried by no joint, {first:?} and {second:?} among them: one root is needed",
                    roots.len()
                );
                return Err(robot_fault(reason));
            }
        }
        let mut children = vec![Vec::new(); urdf.links.len()];
        for &[parent, child] in &ends {
            children[parent].push(child);
        }
        let mut order = roots;
        let mut next = 0;
        while let Some(&link) = order.get(next) {
            order.extend(&children[link]);
            next += 1;
        }
        if order.len() < urdf.links.len() {
            let mut is_found = vec![false; urdf.links.len()];
            for &link in &order {
                is_found[link] = true;
            }
            let lost = is_found.iter().position(|&found| !found).unwrap_or_default();
            let reason = format!("the link {:?} is carried by itself in the end", urdf.links[lost].name);
            return Err(fault(urdf.links[lost].line, reason));
        }
        Ok(Self { ends, order })
    }
}
