//! Where and in which order the nodes under some roots are computed: the last stop before code is printed.
//!
//! A node belongs to the innermost stage of its inputs, so whatever does not change inside a loop is computed outside it.

use super::{Binary, Id, Node, Pool, Sweep, Symbol, reachable};

/// How often a value changes: 0 never, then once per call, per cell, per point, ... as the caller decides; larger is further inside.
pub type Stage = u8;

/// Stages, statements, use counts and costs of the nodes under some roots.
#[derive(Clone, Debug)]
pub struct Schedule {
    stages: Sweep<Stage>,
    uses: Sweep<u32>,
    named: Sweep<bool>,
    statements: Vec<Vec<Id>>,
    costs: Vec<u32>,
}

impl Schedule {
    /// Schedules everything under the roots, which are taken to be consumed in the innermost stage that occurs.
    pub fn new(pool: &Pool, roots: &[Id], stage_of: &dyn Fn(Symbol) -> Stage) -> Schedule {
        let ids = reachable(pool, roots);
        let stages = stages(pool, roots, &ids, stage_of);
        let innermost = ids.iter().map(|&id| stages.get(id)).max().unwrap_or(0);
        let length = usize::from(innermost) + 1;
        let (statements, costs) = (vec![Vec::new(); length], vec![0; length]);
        let (uses, named) = (Sweep::new(roots, 0), Sweep::new(roots, false));
        let mut schedule = Schedule { stages, uses, named, statements, costs };
        schedule.count_uses(pool, roots, &ids, innermost);
        for id in ids {
            schedule.place(pool, id);
        }
        schedule
    }

    /// Counts uses and marks what crosses into a stage further inside.
    fn count_uses(&mut self, pool: &Pool, roots: &[Id], ids: &[Id], innermost: Stage) {
        let users = ids.iter().map(|&id| (pool.node(id), self.stages.get(id)));
        let arguments = users.flat_map(|(node, stage)| node.arguments().map(move |x| (x, stage)));
        let consumed: Vec<(Id, Stage)> =
            arguments.chain(roots.iter().map(|&root| (root, innermost))).collect();
        for (id, stage) in consumed {
            let uses = self.uses.get(id) + 1;
            self.uses.set(id, uses);
            let is_operation = pool.node(id).arguments().next().is_some();
            if is_operation && (uses > 1 || self.stages.get(id) < stage) {
                self.named.set(id, true);
            }
        }
    }

    fn place(&mut self, pool: &Pool, id: Id) {
        let stage = usize::from(self.stages.get(id));
        let saved = if self.quotient(pool, id).is_some() { Binary::Mul.cost() } else { 0 };
        self.costs[stage] += pool.node(id).cost() - saved;
        if self.named.get(id) {
            self.statements[stage].push(id);
        }
    }

    /// Stage 0 to the innermost that occurs.
    pub fn stages(&self) -> impl DoubleEndedIterator<Item = Stage> + use<> {
        (0..=Stage::MAX).take(self.statements.len())
    }

    /// The stage in which a reachable node is computed.
    pub fn stage(&self, id: Id) -> Stage {
        self.stages.get(id)
    }

    /// How many arguments and roots a reachable node is.
    pub fn uses(&self, id: Id) -> u32 {
        self.uses.get(id)
    }

    /// Whether the node gets a statement of its own: it is used more than once, or in a stage further inside than its own. Constants
    /// and inputs are never named; every other node is printed where it is used.
    pub fn is_named(&self, id: Id) -> bool {
        self.named.get(id)
    }

    /// The named nodes of a stage, arguments before their users.
    pub fn statements(&self, stage: Stage) -> &[Id] {
        self.statements.get(usize::from(stage)).map_or(&[], Vec::as_slice)
    }

    /// Cost of a stage in additions, per pass through it.
    pub fn cost(&self, stage: Stage) -> u32 {
        self.costs.get(usize::from(stage)).copied().unwrap_or(0)
    }

    /// `(x, y)` if the node is the product of `x` and a reciprocal `1/y` without a name, to be printed as the quotient `x / y`.
    pub fn quotient(&self, pool: &Pool, id: Id) -> Option<(Id, Id)> {
        let Node::Binary(Binary::Mul, a, b) = pool.node(id) else { return None };
        let divisor = |id| match pool.node(id) {
            Node::Binary(Binary::Div, _, y) if !self.named.get(id) => Some(y),
            _ => None,
        };
        divisor(b).map(|y| (a, y)).or_else(|| divisor(a).map(|y| (b, y)))
    }
}

fn stages(pool: &Pool, roots: &[Id], ids: &[Id], stage_of: &dyn Fn(Symbol) -> Stage) -> Sweep<Stage> {
    let mut stages = Sweep::new(roots, 0);
    for &id in ids {
        let stage = match pool.node(id) {
            Node::Input(symbol) => stage_of(symbol),
            node => node.arguments().map(|x| stages.get(x)).max().unwrap_or(0),
        };
        stages.set(id, stage);
    }
    stages
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Symbol 1 is of stage 1, symbol 2 of stage 2.
    fn stage_of(symbol: Symbol) -> Stage {
        symbol.0 as Stage
    }

    fn inputs(pool: &mut Pool) -> [Id; 3] {
        [0, 1, 2].map(|s| pool.input(Symbol(s)))
    }

    #[test]
    fn what_does_not_change_inside_is_named_outside() {
        let mut pool = Pool::new();
        let [_, cell, point] = inputs(&mut pool);
        let square = pool.square(cell);
        let root = pool.mul(square, point);
        let schedule = Schedule::new(&pool, &[root], &stage_of);
        assert_eq!(schedule.statements(1), [square]);
        assert_eq!(schedule.statements(2), []);
        assert_eq!((schedule.stage(square), schedule.stage(root)), (1, 2));
        assert_eq!(schedule.stages().map(|s| schedule.cost(s)).collect::<Vec<_>>(), [0, 1, 1]);
    }

    #[test]
    fn only_what_is_used_twice_gets_a_name() {
        let mut pool = Pool::new();
        let [x, y, z] = inputs(&mut pool);
        let (once, twice) = (pool.add(x, y), pool.add(y, z));
        let (a, b) = (pool.mul(once, twice), pool.unary(super::super::Unary::Sin, twice));
        let schedule = Schedule::new(&pool, &[a, b], &|_| 0);
        assert_eq!(schedule.statements(0), [twice]);
        assert_eq!((schedule.uses(once), schedule.uses(twice), schedule.uses(y)), (1, 2, 2));
        assert!(!schedule.is_named(y));
    }

    #[test]
    fn a_root_of_an_outer_stage_is_hoisted() {
        let mut pool = Pool::new();
        let [x, y, _] = inputs(&mut pool);
        let outer = pool.square(x);
        let schedule = Schedule::new(&pool, &[outer, y], &stage_of);
        assert_eq!(schedule.statements(0), [outer]);
    }

    #[test]
    fn a_reciprocal_used_once_is_printed_as_a_division() {
        let mut pool = Pool::new();
        let [x, y, z] = inputs(&mut pool);
        let (a, b) = (pool.div(x, y), pool.div(z, y));
        let alone = Schedule::new(&pool, &[a], &|_| 0);
        assert_eq!(alone.quotient(&pool, a), Some((x, y)));
        assert_eq!(alone.cost(0), Binary::Div.cost());
        let shared = Schedule::new(&pool, &[a, b], &|_| 0);
        assert_eq!(shared.quotient(&pool, a), None);
        assert_eq!(shared.cost(0), Binary::Div.cost() + 2);
    }

    #[test]
    fn statements_come_after_those_they_use() {
        let mut pool = Pool::new();
        let [x, y, _] = inputs(&mut pool);
        let sum = pool.add(x, y);
        let square = pool.square(sum);
        let root = pool.square(square);
        let schedule = Schedule::new(&pool, &[root], &|_| 0);
        assert_eq!(schedule.statements(0), [sum, square]);
    }
}
