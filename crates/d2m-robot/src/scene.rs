//! A robot among obstacles, with what it holds.

use crate::body_box::BodyBox;
use crate::geometry::LinkBody;
use crate::obstacle::{Attached, Obstacle};
use crate::part::{MovingPair, Owner, Part};
use crate::robot::Robot;
use crate::{RobotError, Srdf};
use d2m_bvh::{Budget, QueryOptions, Start, Window, time_of_contact};
use d2m_motion::JointKind;
use d2m_world::{Body, World};
use std::sync::Arc;

/// A robot, obstacles and attached bodies: what paths are checked in.
///
/// Pairs that are checked: all pairs of links, but for those that a joint joins directly and those that the SRDF disables; every
/// link and attached body against every obstacle; an attached body against every link and attached body but its own link. Obstacles
/// among themselves are not.
///
/// ```
/// use d2m_robot::{Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint};
/// # let text = r#"<robot name="slide">
/// #   <link name="rail"><collision><geometry><box size="2 0.1 0.1"/></geometry></collision></link>
/// #   <link name="cart"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
/// #   <link name="stop"><collision><origin xyz="0.5 0 0.2"/><geometry><box size="0.1 1 1"/></geometry></collision></link>
/// #   <joint name="run" type="prismatic"><parent link="rail"/><child link="cart"/><origin xyz="0 0 0.2"/></joint>
/// #   <joint name="weld" type="fixed"><parent link="rail"/><child link="stop"/></joint>
/// # </robot>"#;
/// let robot = Robot::parse("slide.urdf", text, &RobotOptions::new())?;
/// let scene = RobotScene::new(robot.into(), None, d2m_bvh::QueryOptions::default())?;
/// let point = |time: f64, x: f64| TrajectoryPoint::new(time, vec![x]);
/// let path = Trajectory::new(vec!["run".into()], vec![point(0.0, 0.0), point(2.0, 1.0)]);
/// let answer = scene.check_path(&path)?;
/// let contact = answer.contact().unwrap();
/// // The cart is stopped after 0.4 of its way of 1 in 2 seconds.
/// assert!((answer.free_until() - 0.8).abs() < 1e-8 && answer.free_until() < 0.8);
/// assert_eq!([contact.a.as_str(), contact.b.as_str()], ["cart", "stop"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct RobotScene {
    pub(crate) robot: Arc<Robot>,
    pub(crate) world: World,
    /// By the places of the world's bodies.
    pub(crate) parts: Arc<Vec<Part>>,
    /// The pairs that are checked, by the places of their parts; also those that never move against each other.
    pub(crate) pairs: Arc<Vec<[usize; 2]>>,
    /// Those of them that are searched: not the ones that never move against each other and are proven apart.
    pub(crate) moving_pairs: Arc<Vec<MovingPair>>,
}

impl RobotScene {
    /// The robot alone. The options hold for every pair; a minimum separation in them is kept between all bodies, and their start says
    /// what counts of those that are in contact at the start of a path.
    ///
    /// # Errors
    /// A minimum separation that is negative or not finite, a tolerance that is not above zero or not finite.
    #[expect(clippy::needless_pass_by_value, reason = "as its sisters, and as every caller has it")]
    pub fn new(robot: Arc<Robot>, srdf: Option<&Srdf>, options: QueryOptions) -> Result<Self, RobotError> {
        check_options(&options)?;
        let mut scene = Self {
            world: World::new(options),
            robot: Arc::clone(&robot),
            parts: Arc::default(),
            pairs: Arc::default(),
            moving_pairs: Arc::default(),
        };
        let rest = robot.complete(vec![None; robot.joints.len()])?;
        let chains = robot.chains(&rest)?;
        let is_checked = |a: usize, b: usize| {
            let disabled = |srdf: &Srdf| srdf.disables(&robot.links[a].name, &robot.links[b].name);
            a != b && !robot.is_joined(a, b) && !srdf.is_some_and(disabled)
        };
        for (link, of) in robot.links.iter().enumerate() {
            for LinkBody { tree, radius, solid, origin, .. } in &of.bodies {
                let is_link_frame = *origin == crate::urdf::Origin::default();
                let frame = if is_link_frame { None } else { Some(origin.joint(JointKind::Fixed)?) };
                let motion = match &frame {
                    None => chains[link].clone(),
                    Some(frame) => chains[link].and(frame.clone())?,
                };
                let body = Body::new(Arc::clone(tree), motion).with_solid(*solid).with_radius(*radius);
                let owner = Owner::Link { link, frame };
                scene.add(&of.name, owner, body, |other| {
                    other.carrier().is_none_or(|carrier| is_checked(link, carrier))
                })?;
            }
        }
        Ok(scene)
    }

    /// The robot.
    pub fn robot(&self) -> &Arc<Robot> {
        &self.robot
    }

    /// The options of all pairs.
    pub const fn options(&self) -> &QueryOptions {
        self.world.options()
    }

    /// Another budget for the queries from now on, say one that can be cancelled; it is one for each path or edge.
    pub const fn set_budget(&mut self, budget: Budget) {
        self.world.set_budget(budget);
    }

    /// Adds an obstacle.
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
    /// use d2m_bvh::{MeshTree, TriMesh};
    /// use d2m_robot::Obstacle;
    /// use glam::{DQuat, DVec3};
    /// let wire = TriMesh::segment(DVec3::new(0.2, -1.0, 0.2), DVec3::new(0.2, 1.0, 0.2))?;
    /// let wire = Obstacle::at_rest("wire", MeshTree::new(wire).into(), DVec3::ZERO, DQuat::IDENTITY)?;
    /// scene.add_obstacle(wire.clone())?;
    /// let answer = scene.check_path(&to(0.3))?;
    /// assert_eq!(answer.contact().expect("the cart meets the wire").b, "wire");
    /// assert!(scene.add_obstacle(wire).is_err(), "the name is taken");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The name of a link or of another body; a radius that is negative or not finite.
    pub fn add_obstacle(&mut self, obstacle: Obstacle) -> Result<(), RobotError> {
        let Obstacle { name, tree, motion, solid, radius, is_at_rest } = obstacle;
        self.check_name(&name)?;
        check_radius(&name, radius)?;
        let solid = solid.unwrap_or_else(|| tree.usual_solid());
        let body = Body::with_shared(tree, motion).with_solid(solid).with_radius(radius);
        self.add(&name, Owner::Obstacle { is_at_rest }, body, |other| {
            !matches!(other.owner, Owner::Obstacle { .. })
        })
    }

    /// Attaches a body to a link.
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
    /// use d2m_bvh::{MeshTree, TriMesh};
    /// use d2m_robot::Attached;
    /// use glam::{DQuat, DVec3};
    /// let pole = TriMesh::segment(DVec3::ZERO, DVec3::X * 0.2)?;
    /// scene.attach(Attached::new("pole", "cart", MeshTree::new(pole).into(), DVec3::ZERO, DQuat::IDENTITY)?)?;
    /// assert_eq!(scene.check_path(&to(0.3))?.contact().expect("the pole meets the stop").b, "pole");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The name of a link or of another body, a radius that is negative or not finite, or a link that the robot does not have.
    pub fn attach(&mut self, attached: Attached) -> Result<(), RobotError> {
        let Attached { name, link: carrier, tree, frame, solid, radius } = attached;
        self.check_name(&name)?;
        check_radius(&name, radius)?;
        let link = self.robot.find_link(&carrier).ok_or_else(|| RobotError::Body {
            name: name.clone(),
            reason: format!("it is attached to {carrier:?}, which is no link of the robot"),
        })?;
        let solid = solid.unwrap_or_else(|| tree.usual_solid());
        let rest = self.robot.complete(vec![None; self.robot.joints.len()])?;
        let motion = self.robot.chains(&rest)?[link].and(frame.clone())?;
        let body = Body::new(tree, motion).with_solid(solid).with_radius(radius);
        self.add(
            &name,
            Owner::Attached { link, frame },
            body,
            |other| !matches!(other.owner, Owner::Link { link: of, .. } if of == link),
        )
    }

    /// Leaves out a pair of links or bodies, by their names; false if one of the names is unknown.
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
    /// assert!(!scene.check_path(&to(0.6))?.is_free());
    /// assert!(scene.ignore("cart", "stop") && !scene.ignore("cart", "nobody"));
    /// assert!(scene.check_path(&to(0.6))?.is_free());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn ignore(&mut self, a: &str, b: &str) -> bool {
        let parts = |name: &str| {
            let named = self.parts.iter().enumerate().filter(|(_, part)| part.name == name);
            named.map(|(index, _)| index).collect::<Vec<_>>()
        };
        let (first, second) = (parts(a), parts(b));
        for &a in &first {
            for &b in &second {
                self.ignore_parts(a, b);
            }
        }
        self.has_name(a) && self.has_name(b)
    }

    /// Adds a body; the pairs with some of those before it are checked.
    fn add(
        &mut self,
        name: &str,
        owner: Owner,
        body: Body,
        is_checked: impl Fn(&Part) -> bool,
    ) -> Result<(), RobotError> {
        let body_box = BodyBox::around(body.tree().mesh().vertices(), &owner.place_of(&body)?);
        let radius = body.radius();
        let id = self.world.add(body);
        let place = id.index();
        Arc::make_mut(&mut self.parts).push(Part { id, name: name.to_owned(), owner, radius, body_box });
        for other in 0..place {
            if is_checked(&self.parts[other]) {
                Arc::make_mut(&mut self.pairs).push([other, place]);
                self.search([other, place]);
            } else {
                self.ignore_in_world([other, place]);
            }
        }
        Ok(())
    }

    /// Whether a checked pair has to be searched along paths: not if it never moves against each other and is proven apart.
    fn search(&mut self, pair: [usize; 2]) {
        let is_settled = self.are_rigid(pair) && self.are_apart(pair);
        let [a, b] = pair.map(|part| &self.parts[part]);
        self.world.ignore_pair(a.id, b.id, is_settled);
        if is_settled {
            return;
        }
        let (options, radii) = (self.pair_options(pair), a.radius + b.radius);
        let size = |part: &Part| self.world.body(part.id).tree().radius() + part.radius;
        let tolerance = options.tolerance_of(size(a).max(size(b)).next_up()).next_up();
        // Meshes that are further apart than this belong to bodies that are not in contact, at the start neither.
        let separation = ((options.min_separation + tolerance).next_up() + radii.next_up()).next_up();
        let seen_from = match [a.carrier(), b.carrier()] {
            [Some(a), Some(b)] => self.robot.last_common(a, b),
            _ => None,
        };
        Arc::make_mut(&mut self.moving_pairs).push(MovingPair { parts: pair, separation, seen_from });
    }

    /// The options of a pair of bodies.
    pub(crate) fn pair_options(&self, pair: [usize; 2]) -> QueryOptions {
        let [a, b] = pair.map(|part| self.parts[part].id);
        self.world.pair_options(a, b)
    }

    /// Does nothing that moves lie between these two?
    fn are_rigid(&self, pair: [usize; 2]) -> bool {
        let group = |part: &Part| match part.owner {
            Owner::Obstacle { is_at_rest: false } => None,
            Owner::Obstacle { is_at_rest: true } => Some(self.robot.rigid_group(self.robot.root())),
            Owner::Link { link, .. } | Owner::Attached { link, .. } => Some(self.robot.rigid_group(link)),
        };
        let [a, b] = pair.map(|part| group(&self.parts[part]));
        a.is_some() && a == b
    }

    /// Are these two, which never move against each other, proven apart? As the robot stands at rest; the pair query sees them from
    /// their last common joint, after which nothing moves.
    fn are_apart(&self, pair: [usize; 2]) -> bool {
        let [a, b] = pair.map(|part| self.world.body(self.parts[part].id).moving());
        let options = self.pair_options(pair).with_start(Start::Report);
        let now = Window::try_new(0.0, 0.0);
        now.is_ok_and(|now| time_of_contact(a, b, now, &options).is_ok_and(|answer| answer.is_separated()))
    }

    fn ignore_in_world(&mut self, pair: [usize; 2]) {
        let [a, b] = pair.map(|part| self.parts[part].id);
        self.world.ignore_pair(a, b, true);
    }

    fn ignore_parts(&mut self, a: usize, b: usize) {
        Arc::make_mut(&mut self.pairs).retain(|pair| *pair != [a, b] && *pair != [b, a]);
        self.stop_searching([a, b]);
        self.ignore_in_world([a, b]);
    }

    fn stop_searching(&mut self, [a, b]: [usize; 2]) {
        Arc::make_mut(&mut self.moving_pairs).retain(|pair| pair.parts != [a, b] && pair.parts != [b, a]);
    }

    /// The checked pairs of two links or bodies.
    fn pairs_of(&self, names: [&str; 2]) -> Vec<[usize; 2]> {
        let are_named = |pair: &&[usize; 2]| {
            let [a, b] = pair.map(|part| self.parts[part].name.as_str());
            names == [a, b] || names == [b, a]
        };
        self.pairs.iter().filter(are_named).copied().collect()
    }

    fn has_names(&self, names: [&str; 2]) -> bool {
        names.iter().all(|name| self.has_name(name))
    }

    /// What counts of two links or bodies that are in contact at the start of a path, by their names, instead of what the options say. With
    /// [`Start::Leave`] it is let go until they are proven apart: of a part that stands on a table until the robot lifts it. False if one of
    /// the names is unknown.
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
    /// use d2m_bvh::Start;
    /// // Starts inside of the stop, and drives away from it.
    /// let point = |time: f64, x: f64| TrajectoryPoint::new(time, vec![x]);
    /// let away = Trajectory::new(vec!["run".into()], vec![point(0.0, 0.41), point(1.0, -0.5)]);
    /// assert_eq!(scene.check_path(&away)?.free_until(), 0.0);
    /// assert!(scene.set_start(["cart", "stop"], Start::Leave));
    /// assert!(scene.check_path(&away)?.is_free());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_start(&mut self, names: [&str; 2], start: Start) -> bool {
        for pair in self.pairs_of(names) {
            let [a, b] = pair.map(|part| self.parts[part].id);
            self.world.set_start(a, b, Some(start));
        }
        self.has_names(names)
    }

    /// The distance at which two links or bodies count as in contact, by their names, instead of that of the options. False if one of the
    /// names is unknown.
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
    /// assert!(scene.set_min_separation(["cart", "stop"], 0.2)?);
    /// let until = scene.check_path(&to(0.4 - 1e-6))?.free_until(); // 0.2 before it would touch
    /// assert!(until <= 0.501 && until > 0.499);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A distance that is negative or not finite.
    pub fn set_min_separation(&mut self, names: [&str; 2], distance: f64) -> Result<bool, RobotError> {
        check_separation(distance)?;
        for pair in self.pairs_of(names) {
            let [a, b] = pair.map(|part| self.parts[part].id);
            self.world.set_min_separation(a, b, Some(distance));
            self.stop_searching(pair);
            self.search(pair);
        }
        Ok(self.has_names(names))
    }

    /// The names of links, then those of obstacles and attached bodies.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let bodies = self.parts.iter().filter(|part| !matches!(part.owner, Owner::Link { .. }));
        self.robot.links.iter().map(|link| link.name.as_str()).chain(bodies.map(|part| part.name.as_str()))
    }

    /// Is this the name of a link or of a body?
    pub fn has_name(&self, name: &str) -> bool {
        self.robot.find_link(name).is_some() || self.parts.iter().any(|part| part.name == name)
    }

    fn check_name(&self, name: &str) -> Result<(), RobotError> {
        if !self.has_name(name) {
            return Ok(());
        }
        let is_link = self.robot.find_link(name).is_some();
        let reason =
            format!("{} has this name already", if is_link { "a link of the robot" } else { "another body" });
        Err(RobotError::Body { name: name.to_owned(), reason })
    }
}

/// Bodies that are far apart are never queried, so that no query would refuse these.
fn check_options(options: &QueryOptions) -> Result<(), RobotError> {
    check_separation(options.min_separation)?;
    match options.tolerance {
        Some(tolerance) if !(tolerance.is_finite() && tolerance > 0.0) => {
            Err(RobotError::path("tolerance", format!("{tolerance:?} is not a finite number above zero")))
        }
        _ => Ok(()),
    }
}

fn check_separation(separation: f64) -> Result<(), RobotError> {
    if separation.is_finite() && separation >= 0.0 {
        return Ok(());
    }
    let reason = format!("{separation:?} is not a finite number that is not negative");
    Err(RobotError::path("min_separation", reason))
}

fn check_radius(name: &str, radius: f64) -> Result<(), RobotError> {
    if radius.is_finite() && radius >= 0.0 {
        return Ok(());
    }
    let reason = format!("its radius {radius:?} is not a finite number that is not negative");
    Err(RobotError::Body { name: name.to_owned(), reason })
}
