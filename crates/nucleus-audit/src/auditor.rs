//! Watches a run state by state.

use std::collections::HashSet;
use std::fmt;

use nalgebra::Vector3;

use crate::crossings::Motion;
use crate::event::{Event, Overlapping, Pair};
use crate::ground::{Ground, Plane};
use crate::intersections::intersections;
use crate::overlap::Overlap;
use crate::passage::Passage;
use crate::tangle::Tangle;
use crate::window::Windows;
use crate::world::{EdgeId, FaceId, Rules, World};

/// Findings that are kept word for word. All are counted.
const KEPT: usize = 100;

/// When a state was reached.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Moment {
    /// The frame that ends last.
    pub frame: i64,
    /// The substep of that frame, counted from 1; 0 before the first.
    pub substep: u32,
}

/// What was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum What {
    /// A pair did not stay apart on the way to a state.
    Passage(Event),
    /// An edge is inside a face in a state, and was not seen to get there.
    Overlap(Overlapping),
    /// A vertex was above the ground plane and is below it.
    Ground(u32),
}

/// Something that should not have been.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finding {
    /// The state at the end of the motion.
    pub moment: Moment,
    /// What it was.
    pub what: What,
}

/// What a run has come to so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Account {
    /// Motions looked at.
    pub motions: u64,
    /// Pairs that changed sides.
    pub crossings: u64,
    /// Pairs that touched without changing sides.
    pub touches: u64,
    /// Degenerate pairs, and such as are not finite.
    pub undecided: u64,
    /// Edges found inside faces that were not seen to get there.
    pub overlaps: u64,
    /// Vertices that went from above the ground plane to below it.
    pub below_ground: u64,
    /// Pairs of edge and face that were inside each other at the start.
    pub tangled_at_start: u64,
    /// Those of them, and of what they were dragged into, that were so when last looked.
    pub tangled: u64,
    /// Events that only carried such a tangle on; they count as nothing else.
    pub excused: u64,
    /// Pairs of edge and face that were inside each other when last looked.
    pub inside: u64,
}

impl Account {
    /// Findings of all kinds together.
    pub fn found(&self) -> u64 {
        self.crossings + self.touches + self.undecided + self.overlaps + self.below_ground
    }

    /// Whether nothing was found.
    pub fn is_clean(&self) -> bool {
        self.found() == 0
    }
}

/// Follows a run from its start state, told of one state after the other, and lists whatever passed through
/// whatever on the way.
#[derive(Debug)]
pub struct Auditor {
    world: World,
    rules: Rules,
    state: Vec<Vector3<f64>>,
    /// What is known of the motions to come.
    windows: Windows,
    tangle: Tangle,
    ground: Ground,
    /// Overlaps that were reported, until they have come apart.
    reported: HashSet<(EdgeId, FaceId)>,
    account: Account,
    findings: Vec<Finding>,
}

impl Auditor {
    /// Begins at a start state: the positions of all bodies one after the other. What is inside each other there is
    /// no finding, until it has come apart.
    ///
    /// # Panics
    /// When there are not as many positions as points.
    pub fn new(world: World, rules: Rules, start: &[Vector3<f64>]) -> Self {
        let inside = intersections(&world, &rules, start);
        let count = inside.len() as u64;
        let account =
            Account { tangled_at_start: count, tangled: count, inside: count, ..Account::default() };
        let (tangle, state) = (Tangle::new(&inside), start.to_vec());
        Self {
            world,
            rules,
            state,
            windows: Windows::default(),
            tangle,
            ground: Ground::default(),
            reported: HashSet::new(),
            account,
            findings: Vec::new(),
        }
    }

    /// Replaces the rules from the next motion on. What is inside each other by then and was not to be looked at so far
    /// is treated as if it had been so at the start.
    pub fn set_rules(&mut self, rules: Rules) {
        if rules == self.rules {
            return;
        }
        self.rules = rules;
        self.windows.reset();
        let inside = intersections(&self.world, &self.rules, &self.state);
        let news: Vec<Overlapping> = inside
            .iter()
            .filter(|found| !self.tangle.has(found) && !self.reported.contains(&(found.edge, found.face)))
            .copied()
            .collect();
        self.account.tangled_at_start += news.len() as u64;
        self.tangle.add(&news);
        self.count_state(&inside);
    }

    /// Looks at the ground plane on the way to the next state, which is taken up afterwards: which vertices of a body
    /// were above it and are below it now? `planes` are those at the start and the end of the motion; nothing where the
    /// body meets none. Below means by more than 1e-6 of the largest coordinate of the body and of the plane's origin.
    ///
    /// # Panics
    /// When there are not as many positions as points.
    pub fn see_ground(
        &mut self,
        moment: Moment,
        body: usize,
        planes: Option<[Plane; 2]>,
        positions: &[Vector3<f64>],
    ) {
        let states = [self.state.as_slice(), positions];
        let passed = self.ground.passed((&self.world, &self.rules), body, planes, states);
        self.account.below_ground += passed.len() as u64;
        passed.into_iter().for_each(|point| self.keep(Finding { moment, what: What::Ground(point) }));
    }

    /// Takes up the next state: looks at the straight motion to it, and at the state itself where the motion gives
    /// cause to.
    ///
    /// # Panics
    /// When there are not as many positions as points.
    pub fn see(&mut self, moment: Moment, positions: &[Vector3<f64>]) {
        self.account.motions += 1;
        let events = self.move_to(positions, true);
        for event in events {
            self.count_passage(event.passage);
            self.keep(Finding { moment, what: What::Passage(event) });
        }
    }

    /// Takes up the next state where the way to it is not known, and looks at it alone: what is inside what, that was
    /// not before?
    ///
    /// # Panics
    /// When there are not as many positions as points.
    pub fn follow(&mut self, moment: Moment, positions: &[Vector3<f64>]) {
        // A tangle is still followed along the straight way, which is the best guess there is.
        if self.tangle.is_empty() {
            self.state.copy_from_slice(positions);
            self.windows.reset();
        } else {
            self.move_to(positions, false);
        }
        self.look(moment);
    }

    /// Takes up a state, and returns the events on the way that carry no tangle on. With `seen` nothing that they
    /// lead to is news any more.
    fn move_to(&mut self, positions: &[Vector3<f64>], seen: bool) -> Vec<Event> {
        let motion = Motion::new(&self.world, &self.rules, [&self.state, positions]);
        let mut events = self.windows.crossings(&motion);
        self.state.copy_from_slice(positions);
        if events.is_empty() && self.tangle.is_empty() {
            return events;
        }
        let reach = self.tangle.take(&self.world, &mut events);
        self.account.excused += reach.taken;
        let inside = intersections(&self.world, &self.rules, &self.state);
        self.tangle.settle(&reach, &inside);
        if seen {
            let news = inside.iter().filter(|found| !self.tangle.has(found));
            self.reported = news.map(|found| (found.edge, found.face)).collect();
        }
        self.count_state(&inside);
        events
    }

    /// Looks at the state that was taken up last: what is inside what, that was not seen to get there?
    pub fn look(&mut self, moment: Moment) {
        let inside = intersections(&self.world, &self.rules, &self.state);
        let is_inside: HashSet<_> = inside.iter().map(|found| (found.edge, found.face)).collect();
        self.reported.retain(|pair| is_inside.contains(pair));
        for &found in &inside {
            let pair = (found.edge, found.face);
            if self.tangle.has(&found) || !self.reported.insert(pair) {
                continue;
            }
            match found.overlap {
                Overlap::Undecided => self.account.undecided += 1,
                _ => self.account.overlaps += 1,
            }
            self.keep(Finding { moment, what: What::Overlap(found) });
        }
        self.count_state(&inside);
    }

    fn count_state(&mut self, inside: &[Overlapping]) {
        self.account.inside = inside.len() as u64;
        self.account.tangled = self.tangle.len() as u64;
    }

    fn count_passage(&mut self, passage: Passage) {
        let counter = match passage {
            Passage::Apart => return,
            Passage::Crosses { .. } => &mut self.account.crossings,
            Passage::Touches { .. } => &mut self.account.touches,
            Passage::Undecided => &mut self.account.undecided,
        };
        *counter += 1;
    }

    fn keep(&mut self, finding: Finding) {
        if self.findings.len() < KEPT {
            self.findings.push(finding);
        }
    }

    /// The counts so far.
    pub fn account(&self) -> Account {
        self.account
    }

    /// The first findings, in order of time.
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// What there is to meet.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// A finding in words: `frame 14, substep 2: point sheet.vtx[12] went through face ball.vtx[3,4,5]`.
    pub fn describe<'a>(&'a self, finding: &'a Finding) -> impl fmt::Display + 'a {
        Described { world: &self.world, finding }
    }
}

struct Described<'a> {
    world: &'a World,
    finding: &'a Finding,
}

impl Described<'_> {
    fn element(&self, f: &mut fmt::Formatter<'_>, kind: &str, points: &[u32]) -> fmt::Result {
        let (body, _) = self.world.local(points[0]);
        let numbers: Vec<String> = points.iter().map(|&p| self.world.local(p).1.to_string()).collect();
        write!(f, "{kind} {}.vtx[{}]", self.world.bodies()[body].name, numbers.join(","))
    }

    fn edge(&self, f: &mut fmt::Formatter<'_>, edge: EdgeId) -> fmt::Result {
        self.element(f, "edge", &self.world.edges()[edge.0 as usize])
    }

    fn face(&self, f: &mut fmt::Formatter<'_>, face: FaceId) -> fmt::Result {
        self.element(f, "face", &self.world.triangles()[face.0 as usize])
    }
}

impl fmt::Display for Described<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Finding { moment, what } = self.finding;
        write!(f, "frame {}, substep {}: ", moment.frame, moment.substep)?;
        match *what {
            What::Passage(Event { pair, passage }) => {
                let verb = match passage {
                    Passage::Touches { .. } => "touched",
                    Passage::Undecided => "may have gone through",
                    Passage::Crosses { .. } | Passage::Apart => "went through",
                };
                match pair {
                    Pair::PointFace(point, face) => {
                        self.element(f, "point", &[point])?;
                        write!(f, " {verb} ")?;
                        self.face(f, face)
                    }
                    Pair::EdgeEdge(a, b) => {
                        self.edge(f, a)?;
                        write!(f, " {verb} ")?;
                        self.edge(f, b)
                    }
                }
            }
            What::Ground(point) => {
                self.element(f, "point", &[point])?;
                write!(f, " went through the ground plane")
            }
            What::Overlap(Overlapping { edge, face, .. }) => {
                self.edge(f, edge)?;
                write!(f, " is inside ")?;
                self.face(f, face)
            }
        }
    }
}
