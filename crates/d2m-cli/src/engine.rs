//! One prepared pair of bodies for every method.

use crate::arguments::{FurtherArguments, Method, QueryArguments, SizeArguments, SolidArguments};
use crate::failure::Failure;
use crate::load::Loaded;
use crate::output::note;
use crate::trials::Trial;
use crate::unlike_sizes::warn_of_sizes;
use d2m::bvh::{
    Budget, Clearance, ClearanceOptions, ContactSpan, Departure, DistanceOptions, MeshTree, Mode, Moving,
    Posed, QueryError, QueryOptions, Solid, TimeOfContact, TriMesh, Window, clearance, contact_spans,
    departure, distance_within, time_of_contact,
};
use d2m::motion::{AnyMotion, RigidMotion};
use d2m::paper::{self, SphereTree};
use d2m_io::{check_keyframes, query_fault};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::time::{Duration, Instant};

/// A mesh with its tree and the name that the user gave it.
pub(crate) struct Body {
    pub(crate) name: String,
    tree: Tree,
}

/// What the chosen method searches.
enum Tree {
    Engine(MeshTree),
    Paper(Box<SphereTree>),
}

impl Body {
    fn new(loaded: Loaded, method: Method) -> Self {
        let name = loaded.name.clone();
        let tree = match method {
            Method::Accurate | Method::Capoeira => Tree::Engine(loaded.into_tree()),
            Method::Paper => Tree::Paper(Box::new(SphereTree::new(loaded.into_mesh()))),
        };
        Self { name, tree }
    }

    /// The mesh.
    pub(crate) fn mesh(&self) -> &TriMesh {
        match &self.tree {
            Tree::Engine(tree) => tree.mesh(),
            Tree::Paper(tree) => tree.mesh(),
        }
    }

    /// The engine's tree; none with the reference method.
    pub(crate) const fn tree(&self) -> Option<&MeshTree> {
        match &self.tree {
            Tree::Engine(tree) => Some(tree),
            Tree::Paper(_) => None,
        }
    }

    fn is_watertight(&self) -> bool {
        match &self.tree {
            Tree::Engine(tree) => tree.is_watertight(),
            Tree::Paper(tree) => tree.is_watertight(),
        }
    }
}

/// Two bodies with their motions, and the options of the query.
pub(crate) struct Pair {
    pub(crate) a: Body,
    pub(crate) b: Body,
    /// What counts as contact with each body.
    pub(crate) solids: [Solid; 2],
    /// Each body is everything within this distance of its mesh.
    pub(crate) radii: [f64; 2],
    /// Distance at which the bodies count as touching.
    pub(crate) min_separation: f64,
    pub(crate) preparation: Duration,
    options: QueryOptions,
}

/// A clearance with the time that it took.
pub(crate) struct ClearanceAnswer {
    pub(crate) found: Clearance,
    pub(crate) took: Duration,
}

/// What was queried besides the first contact.
#[derive(Debug, Default)]
pub(crate) struct Further {
    pub(crate) clearance: Option<Clearance>,
    pub(crate) departure: Option<Departure>,
}

/// An answer with the time that the query alone took.
pub(crate) struct Answer {
    pub(crate) verdict: TimeOfContact,
    pub(crate) took: Duration,
    pub(crate) further: Further,
}

impl Pair {
    /// Checks the options and builds the trees.
    pub(crate) fn new(a: Loaded, b: Loaded, arguments: &QueryArguments) -> Result<Self, Failure> {
        let options = options_of(arguments)?;
        let radii = read_radii(&arguments.sizes)?;
        if radii != [0.0; 2] && arguments.mode == Method::Paper {
            let option = if radii[0] > 0.0 { "--radius-a" } else { "--radius-b" };
            return Err(Failure::at(option, "the reference method has none"));
        }
        let start = Instant::now();
        let [a, b] = [a, b].map(|body| Body::new(body, arguments.mode));
        let preparation = start.elapsed();
        let solids = [
            choose_solid(&a.name, a.is_watertight(), arguments.solid)?,
            choose_solid(&b.name, b.is_watertight(), arguments.solid)?,
        ];
        let [size_a, size_b] = sizes_of([&a, &b], radii);
        warn_of_sizes(size_a, size_b);
        Ok(Self { a, b, solids, radii, min_separation: options.min_separation, preparation, options })
    }

    /// How large the bodies are.
    pub(crate) fn sizes(&self) -> [f64; 2] {
        sizes_of([&self.a, &self.b], self.radii)
    }

    /// The options of its queries.
    pub(crate) const fn options(&self) -> &QueryOptions {
        &self.options
    }

    /// Each query on all threads of the machine: for single ones.
    pub(crate) fn on_all_threads(self) -> Self {
        Self { options: self.options.with_parallel(true), ..self }
    }

    /// The answer of a trial.
    pub(crate) fn answer_trial(&self, trial: &Trial, wanted: FurtherArguments) -> Result<Answer, Failure> {
        check_size("motion of A", &trial.motion_a, &self.a)?;
        check_size("motion of B", &trial.motion_b, &self.b)?;
        self.answer_with([&trial.motion_a, &trial.motion_b], trial.window, wanted)
    }

    /// The first contact, or that after the bodies have parted, and what else is wanted.
    pub(crate) fn answer_with(
        &self,
        [a, b]: [&AnyMotion; 2],
        window: Window,
        wanted: FurtherArguments,
    ) -> Result<Answer, Failure> {
        // Before the search, whose answer decides whether a clearance is computed.
        if wanted.clearance {
            let _accurate = self.moving([a, b], "clearance")?;
        }
        let mut answer = if wanted.leaves() {
            let (found, took) = self.departure([a, b], window)?;
            let further = Further { departure: Some(found), clearance: None };
            Answer { verdict: found.answer, took, further }
        } else {
            self.answer(a, b, window)?
        };
        // After bodies have parted their least distance over the window is another question.
        if wanted.clearance && answer.verdict.is_separated() {
            answer.further.clearance = Some(self.clearance([a, b], window, None)?.found);
        }
        Ok(answer)
    }

    /// The time of contact in a window. The reference method is called piece by piece where both motions have constant
    /// twists, and the first contact is the answer; the default engine needs no such help.
    fn answer(&self, a: &AnyMotion, b: &AnyMotion, window: Window) -> Result<Answer, Failure> {
        if matches!(self.a.tree, Tree::Engine(_)) {
            return self.answer_smooth([a, b], window);
        }
        let mut took = Duration::ZERO;
        let mut start = window.start();
        loop {
            let pieces = a.constant_twist_from(start).zip(b.constant_twist_from(start));
            let Some((piece_a, piece_b)) = pieces else {
                let rest = part(start, window.end())?;
                let answer = self.answer_smooth([a, b], rest)?;
                return Ok(Answer { took: took + answer.took, ..answer });
            };
            let ends = [piece_a.until, piece_b.until].into_iter().flatten();
            let end = ends.fold(window.end(), f64::min);
            let answer = self.answer_smooth([&piece_a.motion, &piece_b.motion], part(start, end)?)?;
            took += answer.took;
            if !answer.verdict.is_separated() || end >= window.end() {
                return Ok(Answer { took, ..answer });
            }
            start = end;
        }
    }

    /// Bounds on the distance at one time; none with the reference method, or where the bodies cannot be placed.
    pub(crate) fn distance_at(&self, motions: [&AnyMotion; 2], time: f64) -> Option<[f64; 2]> {
        let (Tree::Engine(tree_a), Tree::Engine(tree_b)) = (&self.a.tree, &self.b.tree) else { return None };
        let [a, b] = motions.map(|motion| motion.pose_and_twist(time).0);
        let options = DistanceOptions::default().with_solids(self.solids);
        let found = distance_within(Posed::new(tree_a, a), Posed::new(tree_b, b), &options).ok()??;
        let found = found.with_radii(self.radii);
        Some([found.lower, found.upper.max(found.lower)])
    }

    /// The least distance over a window; `None`: the usual accuracy.
    pub(crate) fn clearance(
        &self,
        motions: [&dyn RigidMotion; 2],
        window: Window,
        accuracy: Option<f64>,
    ) -> Result<ClearanceAnswer, Failure> {
        let [a, b] = self.moving(motions, "clearance")?;
        let mut options = ClearanceOptions::default().with_budget(self.options.budget);
        options.parallel = self.options.parallel;
        options.tolerance = self.options.tolerance;
        options.accuracy = accuracy.unwrap_or(options.accuracy);
        let start = Instant::now();
        let found = clearance(a, b, window, &options);
        let took = start.elapsed();
        let found = found.map_err(|error| bad_input(error, motions, window))?;
        Ok(ClearanceAnswer { found, took })
    }

    /// The spans of a window in which the bodies are clear or in contact.
    pub(crate) fn spans(
        &self,
        motions: [&dyn RigidMotion; 2],
        window: Window,
        resolution: Option<f64>,
    ) -> Result<Vec<ContactSpan>, Failure> {
        let [a, b] = self.moving(motions, "spans")?;
        let spans = contact_spans(a, b, window, &self.options, resolution);
        spans.map_err(|error| bad_input(error, motions, window))
    }

    /// When the bodies part, and when they meet after that.
    pub(crate) fn departure(
        &self,
        motions: [&dyn RigidMotion; 2],
        window: Window,
    ) -> Result<(Departure, Duration), Failure> {
        let [a, b] = self.moving(motions, "--start leave")?;
        let start = Instant::now();
        let found = departure(a, b, window, &self.options);
        let took = start.elapsed();
        Ok((found.map_err(|error| bad_input(error, motions, window))?, took))
    }

    /// Both bodies for the default engine: the only one that answers such questions.
    fn moving<'s>(
        &'s self,
        [a, b]: [&'s dyn RigidMotion; 2],
        question: &str,
    ) -> Result<[Moving<'s>; 2], Failure> {
        let [solid_a, solid_b] = self.solids;
        match (&self.a.tree, &self.b.tree) {
            (Tree::Engine(tree_a), Tree::Engine(tree_b)) if self.options.mode == Mode::Accurate => {
                let [a, b] = [(tree_a, a, solid_a), (tree_b, b, solid_b)]
                    .map(|(tree, motion, solid)| Moving::new(tree, motion).with_solid(solid));
                Ok([a.with_radius(self.radii[0]), b.with_radius(self.radii[1])])
            }
            _ => Err(Failure::at("--mode", format!("only accurate answers the question of {question}"))),
        }
    }

    fn answer_smooth(&self, [a, b]: [&dyn RigidMotion; 2], window: Window) -> Result<Answer, Failure> {
        let start = Instant::now();
        let [solid_a, solid_b] = self.solids;
        let verdict = match (&self.a.tree, &self.b.tree) {
            (Tree::Engine(tree_a), Tree::Engine(tree_b)) => {
                let a = Moving::new(tree_a, a).with_solid(solid_a).with_radius(self.radii[0]);
                let b = Moving::new(tree_b, b).with_solid(solid_b).with_radius(self.radii[1]);
                time_of_contact(a, b, window, &self.options)
            }
            (Tree::Paper(tree_a), Tree::Paper(tree_b)) => {
                let a = paper::Moving::new(tree_a, a).with_solid(solid_a);
                let b = paper::Moving::new(tree_b, b).with_solid(solid_b);
                paper::time_of_contact(a, b, window, &self.options)
            }
            _ => unreachable!("both bodies of a pair are prepared for one method"),
        };
        let took = start.elapsed();
        let verdict = verdict.map_err(|error| bad_input(error, [a, b], window))?;
        Ok(Answer { verdict, took, further: Further::default() })
    }
}

/// The diagonals of the boxes around two bodies.
fn sizes_of(bodies: [&Body; 2], radii: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|k| bodies[k].mesh().size() + 2.0 * radii[k])
}

/// An error of a query, with the motion that it comes from.
fn bad_input(error: QueryError, motions: [&dyn RigidMotion; 2], window: Window) -> Failure {
    Failure::Input(query_fault(&error, motions, window))
}

fn part(start: f64, end: f64) -> Result<Window, Failure> {
    Window::try_new(start, end).map_err(|error| Failure::at("window", error))
}

/// Spans of keyframes must meet, to a part of the body's size.
pub(crate) fn check_size(place: &str, motion: &AnyMotion, body: &Body) -> Result<(), Failure> {
    check_keyframes(motion, body.mesh()).map_err(|error| Failure::at(place, error))
}

/// The options of queries, but for what counts as a body.
pub(crate) fn options_of(arguments: &QueryArguments) -> Result<QueryOptions, Failure> {
    let mode = match arguments.mode {
        Method::Accurate | Method::Paper => Mode::Accurate,
        Method::Capoeira => Mode::Capoeira,
    };
    let mut options = QueryOptions::default().with_mode(mode);
    if let Some(text) = &arguments.tolerance {
        options = options.with_tolerance(number("--tolerance", text, TOLERANCE, |t| t > 0.0)?);
    }
    if let Some(text) = &arguments.min_separation {
        if arguments.mode == Method::Paper {
            return Err(Failure::at("--min-separation", "the reference method has none"));
        }
        let distance = number("--min-separation", text, MIN_SEPARATION, |d| d >= 0.0)?;
        options = options.with_min_separation(distance);
    }
    let seconds = number("--time-limit", &arguments.time_limit, "a positive number of seconds", |s| s > 0.0)?;
    // More than a century is no limit, and the type could not hold it.
    let mut budget = Budget::UNLIMITED.with_wall_clock(Duration::from_secs_f64(seconds.min(3e9)));
    if let Some(node_tests) = arguments.budget {
        budget = budget.with_node_tests(node_tests);
    }
    Ok(options.with_budget(budget))
}

/// What `--tolerance` and `--min-separation` take.
pub(crate) const TOLERANCE: &str = "a positive finite distance";
pub(crate) const MIN_SEPARATION: &str = "a finite distance that is not negative";

/// The threads of `--threads`; 0: one for each processor.
pub(crate) fn threads(count: usize) -> Result<ThreadPool, Failure> {
    let pool = ThreadPoolBuilder::new().num_threads(count).build();
    pool.map_err(|error| Failure::at("--threads", error))
}

/// The budget of `--time-limit`.
pub(crate) fn time_limit(text: &str) -> Result<Budget, Failure> {
    let is_time = |seconds: f64| Duration::try_from_secs_f64(seconds).is_ok();
    let seconds = number("--time-limit", text, "a number of seconds that is not negative", is_time)?;
    Ok(Budget::UNLIMITED.with_wall_clock(Duration::from_secs_f64(seconds)))
}

/// Reads an option's value and checks it.
pub(crate) fn number(
    option: &str,
    text: &str,
    wanted: &str,
    is_wanted: impl Fn(f64) -> bool,
) -> Result<f64, Failure> {
    let value: f64 = text.parse().map_err(|_| Failure::at(option, format!("{text:?} is not a number")))?;
    if value.is_finite() && is_wanted(value) {
        Ok(value)
    } else {
        Err(Failure::at(option, format!("{text} is not {wanted}")))
    }
}

/// The radii that the options state: a body is everything within its radius of its mesh.
pub(crate) fn read_radii(sizes: &SizeArguments) -> Result<[f64; 2], Failure> {
    let one = |option: &str, given: &Option<String>| {
        let wanted = "a finite radius that is not negative";
        given.as_deref().map_or(Ok(0.0), |text| number(option, text, wanted, |radius| radius >= 0.0))
    };
    Ok([one("--radius-a", &sizes.radius_a)?, one("--radius-b", &sizes.radius_b)?])
}

/// Filled if the body is watertight, unless the user says otherwise.
pub(crate) fn choose_solid(
    name: &str,
    is_watertight: bool,
    arguments: SolidArguments,
) -> Result<Solid, Failure> {
    match (arguments.surface, is_watertight) {
        (true, _) => Ok(Solid::Surface),
        (false, true) => Ok(Solid::Filled),
        (false, false) if arguments.solid => {
            Err(Failure::at(name, "the mesh is not watertight, so it bounds no solid: use --surface"))
        }
        (false, false) => {
            note(&format!("d2m: note: {name} is not watertight: only its surface counts"));
            Ok(Solid::Surface)
        }
    }
}
