use super::*;
use crate::scalar::*;

fn nh(p: &mut Pool) -> (Id, Vec<Symbol>) {
    let s: Vec<Symbol> = (0..5).map(Symbol).collect();
    let f: Vec<Id> = s.iter().map(|&s| p.input(s)).collect();
    let g = p.input(Symbol(5));
    let k = p.input(Symbol(6));
    // f0 (f4 f3) - f1 (f4 f2)
    let det = if std::env::var("NAIVE").is_ok() {
        let a = p.mul(f[4], f[3]);
        let a = p.mul(f[0], a);
        let b = p.mul(f[4], f[2]);
        let b = p.mul(f[1], b);
        p.sub(a, b)
    } else {
        let a = p.mul(f[0], f[3]);
        let b = p.mul(f[1], f[2]);
        let c = p.sub(a, b);
        p.mul(f[4], c)
    };
    let tr = p.dot(&f, &f);
    let j = p.power(det, Rational::new(-2, 3).unwrap());
    let three = p.constant(3.0);
    let iso = p.mul(j, tr);
    let iso = p.sub(iso, three);
    let two = p.constant(2.0);
    let g2 = p.div(g, two);
    let k2 = p.div(k, two);
    let one = p.one();
    let d = p.sub(det, one);
    let d = p.power(d, Rational::integer(2));
    let a = p.mul(g2, iso);
    let b = p.mul(k2, d);
    (p.add(a, b), s)
}

#[test]
fn count() {
    let mut p = Pool::new();
    let (w, s) = nh(&mut p);
    let mut roots = vec![w];
    let report = |p: &Pool, roots: &[Id], what: &str| {
        let ids = reachable(p, roots);
        let ops = ids.iter().filter(|&&i| p.node(i).cost() > 0).count();
        let cost: u32 = ids.iter().map(|&i| p.node(i).cost()).sum();
        println!("{what}: ops {ops} cost {cost} {}", (0..5).map(|_| ' ').collect::<String>());
    };
    report(&p, &roots, "energy");
    roots.extend(gradient(&mut p, w, &s));
    report(&p, &roots, "gradient");
    roots.extend(hessian(&mut p, w, &s));
    report(&p, &roots, "hessian");
    let roots = lower_powers(&mut p, &roots);
    report(&p, &roots, "lowered");
    if std::env::var("LIST").is_err() {
        return;
    }
    for id in reachable(&p, &roots) {
        let n = match p.node(id) {
            Node::Const(c) => format!("{c}"),
            Node::Input(s) => format!("s{}", s.0),
            Node::Unary(op, x) => format!("{} t{}", op.name(), x.index()),
            Node::Binary(op, x, y) => format!("{} t{} t{}", op.name(), x.index(), y.index()),
            Node::Power(x, p) => format!("t{}^{p}", x.index()),
            _ => "select".into(),
        };
        println!("t{} = {n}{}", id.index(), if roots.contains(&id) { "   <-" } else { "" });
    }
}
