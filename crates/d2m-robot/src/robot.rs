//! A robot: links joined to a tree, with their collision bodies.

use crate::geometry::{LinkBody, NamedMesh, ShapeReader};
use crate::inertial::{Inertial, JointDynamics};
use crate::joints::{JointLimits, JointReader, JointType, Mimic, RobotJoint};
use crate::link_tree::LinkTree;
use crate::packages::read_text;
use crate::urdf::Urdf;
use crate::{RobotError, RobotOptions, Trajectory};
use d2m_bvh::MeshTree;
use d2m_motion::{Arm, Chain, Joint, JointKind, JointValue};
use glam::DVec3;
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Links of one robot at most, and collision bodies: all their pairs are kept.
const MOST_LINKS: usize = 4096;

/// A robot as a URDF file describes it, with the collision bodies of its links.
///
/// The pose of a child in its parent is T(xyz)·Rz(yaw)·Ry(pitch)·Rx(roll)·J(q), J a turn about or a shift along the normalised
/// axis; the frame of the root link is the world. All numbers are taken as the doubles that they are read as. A planar joint J about
/// the axis z has the three numbers `J/x`, `J/y` and `J/theta` (shifts, then a turn), a floating one `J/trans_x`, `J/trans_y` and
/// `J/trans_z` and no turn, by these names in paths.
///
/// ```
/// use d2m_robot::{Robot, RobotOptions};
/// let text = r#"<robot name="slide">
///   <link name="rail"><collision><geometry><box size="2 0.1 0.1"/></geometry></collision></link>
///   <link name="cart"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
///   <joint name="run" type="prismatic"><parent link="rail"/><child link="cart"/>
///     <origin xyz="0 0 0.2"/><axis xyz="2 0 0"/><limit lower="-1" upper="1" velocity="0.5"/></joint>
/// </robot>"#;
/// let robot = Robot::parse("slide.urdf", text, &RobotOptions::new())?;
/// assert_eq!((robot.joint_names(), robot.link_names()), (vec!["run"], vec!["rail", "cart"]));
/// # Ok::<(), d2m_robot::RobotError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Robot {
    name: String,
    file: String,
    text: Arc<str>,
    pub(crate) links: Vec<Link>,
    pub(crate) joints: Vec<RobotJoint>,
    link_by_name: HashMap<String, usize>,
    joint_by_name: HashMap<String, usize>,
    /// Links that a joint joins, the lesser index first.
    joined: HashSet<[usize; 2]>,
    /// The links as an arm, each after its parent, with values of zero.
    arm: Arm,
    /// Where each link is in the arm.
    places: Vec<usize>,
    /// Where each joint is in the arm.
    joint_places: Vec<usize>,
    remarks: Vec<String>,
    files: Vec<PathBuf>,
}

#[derive(Debug, Clone)]
pub(crate) struct Link {
    pub(crate) name: String,
    /// The joints that carry it, one after the other; none: the root.
    pub(crate) joints: Range<usize>,
    pub(crate) bodies: Vec<LinkBody>,
    pub(crate) inertial: Option<Inertial>,
}

impl Robot {
    /// Reads a URDF file and the meshes that it names.
    ///
    /// # Errors
    /// A file that cannot be read, or as [`Robot::parse`].
    pub fn read(path: impl AsRef<Path>, options: &RobotOptions) -> Result<Self, RobotError> {
        let path = path.as_ref();
        let text = read_text(path)?;
        Self::parse(&path.display().to_string(), &text, options)
    }

    /// From the text of a URDF file; meshes are beside the file of that name.
    ///
    /// # Errors
    /// What is no URDF, links that form no tree, joints that mimic in a circle, meshes that
    /// are missing, packages that nothing resolves, a robot without any collision geometry, and more than 4096 links or collision
    /// bodies: with file, line and name.
    pub fn parse(file: &str, text: &str, options: &RobotOptions) -> Result<Self, RobotError> {
        let urdf = Urdf::parse(file, text)?;
        let fault = |reason: String| RobotError::Robot { file: file.to_owned(), reason };
        let tree = LinkTree::new(file, &urdf)?;
        if urdf.links.iter().all(|link| link.collisions.is_empty()) {
            let count = urdf.links.len();
            return Err(fault(format!(
                "none of the {count} links has collision geometry: nothing can be checked"
            )));
        }
        let bodies = urdf.links.iter().map(|link| link.collisions.len()).sum();
        for (what, count) in [("links", urdf.links.len()), ("collision bodies", bodies)] {
            if count > MOST_LINKS {
                return Err(fault(format!("{count} {what}: a robot has at most {MOST_LINKS}")));
            }
        }
        let folder = Path::new(file).parent().unwrap_or(Path::new(""));
        let mut reader = ShapeReader::new(file, folder, options);
        let mut links = Vec::with_capacity(urdf.links.len());
        for link in &urdf.links {
            let bodies = link.collisions.iter().map(|collision| reader.body(&link.name, collision));
            let bodies = bodies.collect::<Result<_, _>>()?;
            let (name, inertial) = (link.name.clone(), link.inertial);
            links.push(Link { name, joints: 0..0, bodies, inertial });
        }
        let ShapeReader { mut remarks, files, .. } = reader;
        let JointReader { joints, remarks: of_joints, .. } = JointReader::read(file, &urdf, &tree.ends)?;
        remarks.extend(of_joints);
        for (index, joint) in joints.iter().enumerate() {
            let before = links[joint.child].joints.clone();
            let first = if before.is_empty() { index } else { before.start };
            links[joint.child].joints = first..index + 1;
        }
        let LinksInArm { arm, places, joint_places } = LinksInArm::new(&links, &joints, &tree.order)?;
        let places_of = |names: &mut dyn Iterator<Item = &String>| names.cloned().zip(0..).collect();
        Ok(Self {
            name: urdf.name,
            file: file.to_owned(),
            text: text.into(),
            link_by_name: places_of(&mut links.iter().map(|link| &link.name)),
            joint_by_name: places_of(&mut joints.iter().map(|joint| &joint.name)),
            joined: tree.ends.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect(),
            links,
            joints,
            arm,
            places,
            joint_places,
            remarks,
            files,
        })
    }

    /// The text of the file: with [`Robot::meshes`] all that is needed to make the same robot on another machine.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The meshes of files that the links have, as the text names them, each name and scale once.
    ///
    /// ```
    /// # use d2m_robot::{Robot, RobotOptions};
    /// use d2m_bvh::MeshTree;
    /// use glam::DVec3;
    /// use std::sync::Arc;
    /// let text = r#"<robot name="one"><link name="body"><collision><geometry>
    ///     <mesh filename="package://somewhere/body.stl" scale="2 2 2"/></geometry></collision></link></robot>"#;
    /// let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=2&y=2&z=2")?));
    /// let options = RobotOptions::new().with_mesh("package://somewhere/body.stl", DVec3::splat(2.0), tree);
    /// let robot = Robot::parse("one.urdf", text, &options)?; // no file is read
    /// let again = robot.meshes().fold(RobotOptions::new(), |options, mesh| {
    ///     options.with_mesh(mesh.name, mesh.scale, Arc::clone(mesh.tree))
    /// });
    /// assert!(Robot::parse(robot.file(), robot.text(), &again).is_ok());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn meshes(&self) -> impl Iterator<Item = RobotMesh<'_>> {
        let mut seen = HashSet::new();
        let named = self.links.iter().flat_map(|link| &link.bodies).filter_map(|body| {
            let NamedMesh { name, scale } = body.mesh.as_ref()?;
            Some(RobotMesh { name, scale: *scale, tree: &body.tree })
        });
        named.filter(move |mesh| seen.insert((mesh.name, mesh.scale.to_array().map(f64::to_bits))))
    }

    /// Its name in the file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The file that it was read from.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The names of the links, in the order of the file.
    pub fn link_names(&self) -> Vec<&str> {
        self.links.iter().map(|link| link.name.as_str()).collect()
    }

    /// The names of the joints that a path has to give: those that move and mimic no other, in the order of the file.
    pub fn joint_names(&self) -> Vec<&str> {
        let free = self.joints.iter().filter(|joint| joint.kind != JointType::Fixed && joint.mimic.is_none());
        free.map(|joint| joint.name.as_str()).collect()
    }

    /// The index of a link.
    pub fn find_link(&self, name: &str) -> Option<usize> {
        self.link_by_name.get(name).copied()
    }

    /// The index of a joint.
    pub fn find_joint(&self, name: &str) -> Option<usize> {
        self.joint_by_name.get(name).copied()
    }

    /// The name of a joint.
    ///
    /// # Panics
    /// An index that is no joint.
    pub fn joint_name(&self, joint: usize) -> &str {
        &self.joints[joint].name
    }

    /// How a joint moves.
    ///
    /// # Panics
    /// An index that is no joint.
    pub fn joint_type(&self, joint: usize) -> JointType {
        self.joints[joint].kind
    }

    /// The limits of a joint.
    ///
    /// # Panics
    /// An index that is no joint.
    pub fn limits(&self, joint: usize) -> JointLimits {
        self.joints[joint].limits
    }

    /// What a joint follows.
    ///
    /// # Panics
    /// An index that is no joint.
    pub fn mimic(&self, joint: usize) -> Option<Mimic> {
        self.joints[joint].mimic
    }

    /// What brakes a joint, as the file states it.
    ///
    /// # Panics
    /// An index that is no joint.
    pub fn dynamics(&self, joint: usize) -> JointDynamics {
        self.joints[joint].dynamics
    }

    /// The mass of a link, as far as the file states it.
    ///
    /// # Panics
    /// An index that is no link.
    pub fn inertial(&self, link: usize) -> Option<Inertial> {
        self.links[link].inertial
    }

    /// Where a joint stays that no path names: at zero, or in the middle of its limits if zero is outside of them.
    ///
    /// ```
    /// # let urdf = r#"<robot name="slide">
    /// #   <link name="rail"><collision><geometry><box size="2 0.1 0.1"/></geometry></collision></link>
    /// #   <link name="cart"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
    /// #   <link name="stop"><collision><origin xyz="0.5 0 0.2"/><geometry><box size="0.1 1 1"/></geometry></collision></link>
    /// #   <joint name="run" type="prismatic"><parent link="rail"/><child link="cart"/><origin xyz="0 0 0.2"/><limit lower="-1" upper="0.6" velocity="2"/></joint>
    /// #   <joint name="weld" type="fixed"><parent link="rail"/><child link="stop"/></joint>
    /// # </robot>"#;
    /// # use d2m_robot::{Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint};
    /// # let robot = Robot::parse("slide.urdf", urdf, &RobotOptions::new())?;
    /// # let mut scene = RobotScene::new(robot.into(), None, d2m_bvh::QueryOptions::default())?;
    /// # let to = |x: f64| {
    /// #     let point = |time: f64, x: f64| TrajectoryPoint::new(time, vec![x]);
    /// #     Trajectory::new(vec!["run".into()], vec![point(0.0, 0.0), point(1.0, x)])
    /// # };
    /// let robot = scene.robot();
    /// assert_eq!(robot.rest_position(robot.find_joint("run").expect("the file has it")), 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Panics
    /// An index that is no joint.
    pub fn rest_position(&self, joint: usize) -> f64 {
        match self.joints[joint].limits.position {
            Some([lower, upper]) if !(lower..=upper).contains(&0.0) => 0.5 * lower + 0.5 * upper,
            _ => 0.0,
        }
    }

    /// What is not exact in the bodies of the links, and by how much: one sentence each.
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    /// The files of the meshes that were read, each with those that it names, as buffers of glTF.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Does a joint join these links directly?
    pub fn is_joined(&self, a: usize, b: usize) -> bool {
        self.joined.contains(&[a.min(b), a.max(b)])
    }

    /// The link whose frame is the world.
    pub(crate) fn root(&self) -> usize {
        self.links.iter().position(|link| link.joints.is_empty()).unwrap_or_default()
    }

    /// The place in the arm of the last link that carries both, or is one of them; none: the world.
    pub(crate) fn last_common(&self, a: usize, b: usize) -> Option<usize> {
        self.arm.last_common(self.places[a], self.places[b])
    }

    /// The index of a link in the robot's arm.
    pub(crate) fn place_in_arm(&self, link: usize) -> usize {
        self.places[link]
    }

    /// The last link on the way to this one that a joint moves, or the root: links of the same never move against each other.
    pub(crate) fn rigid_group(&self, link: usize) -> usize {
        let mut at = link;
        while let Some(joint) =
            self.links[at].joints.clone().last().filter(|&joint| self.joints[joint].kind == JointType::Fixed)
        {
            at = self.joints[joint].parent;
        }
        at
    }

    /// The motion of every link's frame along a path, in the order of [`Robot::link_names`].
    ///
    /// ```
    /// # let urdf = r#"<robot name="slide">
    /// #   <link name="rail"><collision><geometry><box size="2 0.1 0.1"/></geometry></collision></link>
    /// #   <link name="cart"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
    /// #   <link name="stop"><collision><origin xyz="0.5 0 0.2"/><geometry><box size="0.1 1 1"/></geometry></collision></link>
    /// #   <joint name="run" type="prismatic"><parent link="rail"/><child link="cart"/><origin xyz="0 0 0.2"/><limit lower="-1" upper="0.6" velocity="2"/></joint>
    /// #   <joint name="weld" type="fixed"><parent link="rail"/><child link="stop"/></joint>
    /// # </robot>"#;
    /// # use d2m_robot::{Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint};
    /// # let robot = Robot::parse("slide.urdf", urdf, &RobotOptions::new())?;
    /// # let mut scene = RobotScene::new(robot.into(), None, d2m_bvh::QueryOptions::default())?;
    /// # let to = |x: f64| {
    /// #     let point = |time: f64, x: f64| TrajectoryPoint::new(time, vec![x]);
    /// #     Trajectory::new(vec!["run".into()], vec![point(0.0, 0.0), point(1.0, x)])
    /// # };
    /// use d2m_motion::RigidMotion;
    /// let motions = scene.robot().link_motions(&to(0.3))?;
    /// let cart = &motions[scene.robot().find_link("cart").expect("the file has it")];
    /// assert!((cart.pose_and_twist(0.5).0.transform_point(glam::DVec3::ZERO).x - 0.15).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A path that makes no sense, or names joints that the robot does not have.
    pub fn link_motions(&self, path: &Trajectory) -> Result<Vec<Chain>, RobotError> {
        self.chains(&self.all_values(&path.joint_names, path.joint_values()?)?)
    }

    /// The links as an arm with these values of all joints (those of fixed joints are ignored).
    pub(crate) fn arm(&self, values: &[JointValue]) -> Arm {
        let mut arm = self.arm.clone();
        for (&place, value) in self.joint_places.iter().zip(values) {
            arm.set_value(place, value.clone());
        }
        arm
    }

    /// The motion of every link's frame, by the value of every joint.
    pub(crate) fn chains(&self, values: &[JointValue]) -> Result<Vec<Chain>, RobotError> {
        let chains = self.arm(values).links()?;
        Ok(self.places.iter().map(|&place| chains[place].clone()).collect())
    }
}

/// A mesh of links, as their file names it.
///
/// ```
/// # use d2m_robot::{Robot, RobotOptions};
/// let tree = std::sync::Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box")?));
/// let text = r#"<robot name="one"><link name="body"><collision><geometry>
///     <mesh filename="body.stl" scale="1 2 1"/></geometry></collision></link></robot>"#;
/// let scale = glam::DVec3::new(1.0, 2.0, 1.0);
/// let robot = Robot::parse("one.urdf", text, &RobotOptions::new().with_mesh("body.stl", scale, tree))?;
/// let mesh = robot.meshes().next().expect("the link has one");
/// assert_eq!((mesh.name, mesh.scale), ("body.stl", scale));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct RobotMesh<'a> {
    /// The name in the file.
    pub name: &'a str,
    /// The scale that stands there.
    pub scale: DVec3,
    /// The mesh, scaled.
    pub tree: &'a Arc<MeshTree>,
}

/// The links as an arm, and where links and joints are in it.
struct LinksInArm {
    arm: Arm,
    places: Vec<usize>,
    joint_places: Vec<usize>,
}

impl LinksInArm {
    /// In an order of the links in which each comes after its parent.
    fn new(links: &[Link], joints: &[RobotJoint], order: &[usize]) -> Result<Self, RobotError> {
        let mut arm = Arm::default();
        let (mut places, mut joint_places) = (vec![0; links.len()], vec![0; joints.len()]);
        for &link in order {
            let Link { name, joints: carried_by, .. } = &links[link];
            let Some(first) = carried_by.clone().next() else {
                let still = Joint::try_new(DVec3::ZERO, glam::DQuat::IDENTITY, JointKind::Fixed)?;
                places[link] = arm.add(name.as_str(), None, still)?;
                continue;
            };
            // The root carries its children, but its frame is the world: nothing to compute.
            let parent = joints[first].parent;
            let mut at = (!links[parent].joints.is_empty()).then_some(places[parent]);
            for joint in carried_by.clone() {
                joint_places[joint] = arm.add(name.as_str(), at, joints[joint].joint.clone())?;
                at = Some(joint_places[joint]);
            }
            places[link] = joint_places[carried_by.end - 1];
        }
        Ok(Self { arm, places, joint_places })
    }
}
