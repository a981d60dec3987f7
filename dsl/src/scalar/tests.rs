//! Claims about the constructors: what they simplify, and that the value stays.

use proptest::prelude::*;

use super::*;

/// An expression as written, without simplification.
#[derive(Clone, Debug)]
enum Tree {
    Const(f64),
    Input(u32),
    Unary(Unary, Box<Tree>),
    Binary(Binary, Box<[Tree; 2]>),
    Power(Box<Tree>, Rational),
    Select(Relation, Box<[Tree; 4]>),
}

impl Tree {
    fn build(&self, pool: &mut Pool) -> Id {
        match self {
            Tree::Const(c) => pool.constant(*c),
            Tree::Input(s) => pool.input(Symbol(*s)),
            Tree::Unary(op, x) => {
                let x = x.build(pool);
                pool.unary(*op, x)
            }
            Tree::Binary(op, arguments) => {
                let [x, y] = arguments.each_ref().map(|x| x.build(pool));
                pool.binary(*op, x, y)
            }
            Tree::Power(x, p) => {
                let x = x.build(pool);
                pool.power(x, *p)
            }
            Tree::Select(relation, arguments) => {
                let [a, b, c, d] = arguments.each_ref().map(|x| x.build(pool));
                pool.select(*relation, a, b, c, d)
            }
        }
    }

    /// Value with every operation's result passed through `round`; `None` where an intermediate result is not finite.
    fn value(&self, inputs: &[f64], round: &mut dyn FnMut(f64) -> f64) -> Option<f64> {
        let mut of = |tree: &Tree| tree.value(inputs, round);
        let value = match self {
            Tree::Const(c) => return Some(*c),
            Tree::Input(s) => return Some(inputs[*s as usize]),
            Tree::Unary(op, x) => op.value(of(x)?),
            Tree::Binary(op, xy) => op.value(of(&xy[0])?, of(&xy[1])?),
            Tree::Power(x, p) => p.power(of(x)?),
            Tree::Select(relation, arguments) => {
                let [a, b, c, d] = arguments.each_ref().map(of);
                if relation.holds(a?, b?) { c? } else { d? }
            }
        };
        value.is_finite().then(|| round(value))
    }
}

/// Trees over three inputs from the given leaves and operators.
fn trees(
    constants: impl Strategy<Value = f64> + 'static,
    unary: &'static [Unary],
    binary: &'static [Binary],
    powers: &'static [(i64, i64)],
) -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![constants.prop_map(Tree::Const), (0..3u32).prop_map(Tree::Input)];
    let power = prop::sample::select(powers).prop_map(|(n, d)| Rational::new(n, d).unwrap());
    leaf.prop_recursive(4, 24, 4, move |inner| {
        let of_two = (prop::sample::select(binary), inner.clone(), inner.clone());
        let of_four = (prop::sample::select(&Relation::ALL[..]), prop::array::uniform4(inner.clone()));
        prop_oneof![
            1 => (prop::sample::select(unary), inner.clone()).prop_map(|(op, x)| Tree::Unary(op, Box::new(x))),
            3 => of_two.prop_map(|(op, x, y)| Tree::Binary(op, Box::new([x, y]))),
            1 => (inner, power.clone()).prop_map(|(x, p)| Tree::Power(Box::new(x), p)),
            1 => of_four.prop_map(|(relation, arguments)| Tree::Select(relation, Box::new(arguments))),
        ]
    })
}

const WHOLE: &[Binary] = &[Binary::Add, Binary::Sub, Binary::Mul, Binary::Min, Binary::Max];

proptest! {
    /// Small whole numbers are computed without rounding, so the values are equal.
    #[test]
    fn simplified_whole_number_expressions_are_exact(
        tree in trees((-3..=3i8).prop_map(f64::from), &[Unary::Neg, Unary::Abs], WHOLE, &[(0, 1), (1, 1), (2, 1)]),
        inputs in prop::array::uniform3((-3..=3i8).prop_map(f64::from)),
    ) {
        let mut largest = 0.0_f64;
        let expected = tree.value(&inputs, &mut |v| { largest = largest.max(v.abs()); v }).unwrap();
        prop_assume!(largest < 2.0_f64.powi(40)); // room below 2^53 for products that were grouped differently
        let mut pool = Pool::new();
        let root = tree.build(&mut pool);
        prop_assert_eq!(eval(&pool, &[root], &|s| inputs[s.0 as usize])[0], expected);
    }

    /// Rounding may differ; its effect is bounded by the spread of values when every result is disturbed by 1e-11.
    #[test]
    fn simplified_expressions_have_the_value_of_what_was_written(
        tree in trees(
            -2.0..2.0, &Unary::ALL, &Binary::ALL,
            &[(-3, 1), (-1, 1), (2, 1), (5, 1), (-2, 3), (1, 3), (1, 2), (-3, 2), (3, 2), (20, 1)],
        ),
        inputs in prop::array::uniform3(-2.0..2.0),
    ) {
        let Some(expected) = tree.value(&inputs, &mut |v| v) else { return Ok(()) };
        let mut tolerance = 1e-12 * expected.abs() + 1e-300;
        for seed in 1..=8_u32 {
            let mut k = seed;
            let disturbed = tree.value(&inputs, &mut |v| {
                k = k.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                v * (1.0 + 1e-11 * (f64::from(k >> 16) / 32768.0 - 1.0))
            });
            let Some(disturbed) = disturbed else { return Ok(()) };
            tolerance += (disturbed - expected).abs();
        }
        let mut pool = Pool::new();
        let root = tree.build(&mut pool);
        let lowered = lower_powers(&mut pool, &[root])[0];
        for value in eval(&pool, &[root, lowered], &|s| inputs[s.0 as usize]) {
            prop_assert!((value - expected).abs() <= tolerance, "{} instead of {}", value, expected);
        }
    }
}

fn inputs(pool: &mut Pool) -> [Id; 3] {
    [0, 1, 2].map(|s| pool.input(Symbol(s)))
}

#[test]
fn equal_expressions_are_one_node() {
    let mut pool = Pool::new();
    let [x, y, _] = inputs(&mut pool);
    assert_eq!(pool.add(x, y), pool.add(y, x));
    let (a, b) = (pool.mul(x, y), pool.mul(y, x));
    assert_eq!(a, b);
    assert_eq!(pool.sub(a, b), pool.zero());
}

#[test]
fn signs_leave_products_and_vanish_in_sums() {
    let mut pool = Pool::new();
    let [x, y, z] = inputs(&mut pool);
    let minus = pool.neg(x);
    let product = pool.mul(minus, y);
    let plain = pool.mul(x, y);
    assert_eq!(product, pool.neg(plain));
    assert_eq!(pool.add(z, product), pool.sub(z, plain));
}

#[test]
fn constants_of_a_product_merge() {
    let mut pool = Pool::new();
    let [x, y, _] = inputs(&mut pool);
    let (two, half) = (pool.constant(2.0), pool.constant(0.5));
    let halved = pool.mul(half, x);
    let product = pool.mul(y, halved);
    assert_eq!(pool.mul(two, product), pool.mul(y, x));
    let doubled = pool.mul(two, x);
    assert_eq!(pool.add(x, x), doubled);
    let negative = pool.constant(-2.0);
    let opposite = pool.mul(negative, x);
    assert_eq!(pool.add(doubled, opposite), pool.zero());
}

#[test]
fn sums_take_out_common_factors() {
    let mut pool = Pool::new();
    let [x, y, z] = inputs(&mut pool);
    let (xy, xz) = (pool.mul(x, y), pool.mul(x, z));
    let sum = pool.add(y, z);
    assert_eq!(pool.add(xy, xz), pool.mul(x, sum));
}

#[test]
fn quotients_share_the_reciprocal() {
    let mut pool = Pool::new();
    let [x, y, z] = inputs(&mut pool);
    let (a, b) = (pool.div(x, z), pool.div(y, z));
    let divisions = |id: &Id| matches!(pool.node(*id), Node::Binary(Binary::Div, ..));
    assert_eq!(reachable(&pool, &[a, b]).iter().filter(|id| divisions(id)).count(), 1);
}

#[test]
fn powers_merge_where_the_domain_allows() {
    let mut pool = Pool::new();
    let [x, ..] = inputs(&mut pool);
    let root = pool.sqrt(x);
    assert_eq!(pool.square(root), x);
    let square = pool.square(x);
    assert_eq!(pool.sqrt(square), pool.abs(x));
    let third = pool.power(x, Rational::MINUS_THIRD);
    assert_eq!(pool.power(third, Rational::integer(3)), pool.recip(x));
    let (base, exponent) = (pool.constant(2.0), pool.constant(-2.0 / 3.0));
    let power = pool.pow(x, exponent);
    assert_eq!(power, pool.power(x, Rational::new(-2, 3).unwrap()));
    assert_eq!(pool.pow(base, base), pool.constant(4.0));
}

#[test]
fn what_is_not_finite_is_not_folded() {
    let mut pool = Pool::new();
    let (zero, minus) = (pool.zero(), pool.constant(-1.0));
    for id in [pool.recip(zero), pool.sqrt(minus), pool.unary(Unary::Ln, zero), pool.div(zero, zero)] {
        assert_eq!(pool.as_constant(id), None);
    }
}

#[test]
fn choices_that_are_settled_disappear() {
    let mut pool = Pool::new();
    let [x, y, z] = inputs(&mut pool);
    assert_eq!(pool.select(Relation::Less, x, y, z, z), z);
    assert_eq!(pool.select(Relation::Less, x, x, y, z), z);
    assert_eq!(pool.select(Relation::LessEqual, x, x, y, z), y);
    let (one, two) = (pool.one(), pool.constant(2.0));
    assert_eq!(pool.select(Relation::Less, one, two, y, z), y);
    assert_eq!(pool.min(x, x), x);
    let inner = pool.select(Relation::Less, x, y, z, one);
    assert_eq!(pool.select(Relation::Less, x, y, inner, two), pool.select(Relation::Less, x, y, z, two));
}

#[test]
fn a_zero_arm_shields_from_the_other_arms_domain() {
    let mut pool = Pool::new();
    let [x, y, _] = inputs(&mut pool);
    let zero = pool.zero();
    let (root, logarithm) = (pool.sqrt(x), pool.unary(Unary::Ln, x));
    let positive = pool.select(Relation::Less, zero, x, root, zero);
    let product = pool.product([positive, logarithm, y]);
    assert_eq!(eval(&pool, &[product], &|_| -1.0), [0.0]);
}

#[test]
fn substitution_simplifies_and_leaves_other_symbols() {
    let mut pool = Pool::new();
    let [x, y, z] = inputs(&mut pool);
    let difference = pool.sub(x, y);
    let root = pool.mul(difference, z);
    let replaced = substitute(&mut pool, &[root, z], &|s| (s == Symbol(0)).then_some(y));
    assert_eq!(replaced, [pool.zero(), z]);
    assert!(depends_on(&pool, root, Symbol(0)) && !depends_on(&pool, z, Symbol(0)));
}

#[test]
fn sums_of_nothing_are_neutral() {
    let mut pool = Pool::new();
    assert_eq!(pool.sum([]), pool.zero());
    assert_eq!(pool.product([]), pool.one());
    assert_eq!(eval(&pool, &[], &|_| 0.0), []);
}
