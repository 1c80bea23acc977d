//! Whether an expression is linear in some of its names, and with what coefficients.
//!
//! ```text
//! e = Σ_i a_i v_i + b,   a_i and b free of v
//! ```
//!
//! Sums, differences, products with what is free of v, and quotients by it are recognised; all else counts as nonlinear.

use std::collections::BTreeMap;

use super::expression::{Expression, Node};
use super::function::Function;

/// a_i by name, and b under none; what is absent is 0.
pub type Affine = BTreeMap<Option<String>, Expression>;

/// The coefficients; none where linearity is not recognised.
pub fn affine(expression: &Expression, is_variable: &impl Fn(&str) -> bool) -> Option<Affine> {
    if !expression.has(is_variable) {
        let is_zero = expression.value() == Some(0.0);
        return Some(if is_zero { Affine::new() } else { [(None, expression.clone())].into() });
    }
    match &expression.node {
        Node::Number(_) => None,
        Node::Name(name) => Some([(Some(name.clone()), Expression::number(1.0))].into()),
        Node::Apply(function, parts) => {
            let of = |k: usize| affine(&parts[k], is_variable);
            let free = |k: usize| !parts[k].has(is_variable);
            match function {
                Function::Add => Some(sum(of(0)?, of(1)?, Function::Add)),
                Function::Subtract => Some(sum(of(0)?, of(1)?, Function::Subtract)),
                Function::Negative => Some(sum(Affine::new(), of(0)?, Function::Subtract)),
                Function::Multiply if free(0) => Some(scaled(of(1)?, |a| times(parts[0].clone(), a))),
                Function::Multiply if free(1) => Some(scaled(of(0)?, |a| times(a, parts[1].clone()))),
                Function::Divide if free(1) => {
                    Some(scaled(of(0)?, |a| Expression::apply(Function::Divide, vec![a, parts[1].clone()])))
                }
                _ => None,
            }
        }
    }
}

/// a·b, with 1 left out.
fn times(a: Expression, b: Expression) -> Expression {
    match (a.value(), b.value()) {
        (Some(1.0), _) => b,
        (_, Some(1.0)) => a,
        _ => Expression::apply(Function::Multiply, vec![a, b]),
    }
}

fn sum(mut a: Affine, b: Affine, function: Function) -> Affine {
    for (name, right) in b {
        let joined = match (a.remove(&name), function) {
            (Some(left), _) => Expression::apply(function, vec![left, right]),
            (None, Function::Subtract) => Expression::apply(Function::Negative, vec![right]),
            (None, _) => right,
        };
        a.insert(name, joined);
    }
    a
}

fn scaled(a: Affine, by: impl Fn(Expression) -> Expression) -> Affine {
    a.into_iter().map(|(name, coefficient)| (name, by(coefficient))).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::effects::own::expression::parse;

    fn value(expression: &Expression, at: &BTreeMap<&str, f64>) -> f64 {
        match &expression.node {
            Node::Number(value) => *value,
            Node::Name(name) => at[name.as_str()],
            Node::Apply(function, parts) => {
                let mut values = [0.0; 3];
                values.iter_mut().zip(parts).for_each(|(v, part)| *v = value(part, at));
                function.of(values)
            }
        }
    }

    /// Oracle: the expression itself, at numbers: it is what its coefficients say.
    #[test]
    fn coefficients_make_the_expression() {
        let at = BTreeMap::from([("x", 1.7), ("v", -0.3), ("a", 2.5), ("b", 0.4)]);
        for text in [
            "a*x - b*v + 3",
            "-(x - v)/a",
            "(a^2*(x - v) - 2*b*a*v)",
            "2*(x*a + b)/b - v",
            "x - x*a + sin(a)",
            "b - (a - x)",
        ] {
            let expression = parse(text).unwrap();
            let found = affine(&expression, &|name: &str| ["x", "v"].contains(&name)).unwrap();
            let of = |name: &str| found.get(&Some(name.to_string())).map_or(0.0, |a| value(a, &at));
            let rest = found.get(&None).map_or(0.0, |b| value(b, &at));
            let sum = of("x") * at["x"] + of("v") * at["v"] + rest;
            assert!((sum - value(&expression, &at)).abs() < 1e-14, "{text}");
        }
    }

    #[test]
    fn products_and_functions_of_variables_are_not_linear() {
        for text in ["x*v", "x^2", "sin(x)", "a/x", "abs(x) + v", "if(x > 0, a, b)", "max(x, v)"] {
            assert!(affine(&parse(text).unwrap(), &|name: &str| ["x", "v"].contains(&name)).is_none(), "{text}");
        }
    }
}
