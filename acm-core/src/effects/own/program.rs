//! Expressions as a list of operations on registers, each of which holds many samples at once.
//!
//! | class      | depends on                              | computed                       |
//! | ---------- | --------------------------------------- | ------------------------------ |
//! | `Constant` | numbers and parameters                  | once, unless a context moves them |
//! | `Sample`   | columns, inputs and time                | for a block of samples at once |
//! | `State`    | what was before                         | sample by sample               |
//! | `After`    | the states at the sample                | for the block at once          |
//!
//! A part that stands twice is computed once.

use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

use super::expression::{Expression, Node};
use super::function::{Function, chosen};

/// When a register is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    Constant,
    Sample,
    State,
    After,
}

/// One operation: registers in, one register out that is after all of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Operation {
    function: Function,
    to: usize,
    from: [usize; 3],
}

/// Operations by class; see the head of this file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Program {
    /// Class of each register.
    pub classes: Vec<Class>,
    /// Registers that hold numbers.
    pub numbers: Vec<(usize, f64)>,
    /// One list for each class.
    pub operations: [Vec<Operation>; 4],
}

/// Registers of names.
pub type Scope = BTreeMap<String, usize>;

/// Writes a program.
#[derive(Debug, Default)]
pub struct Writer {
    program: Program,
    known: HashMap<(Function, [usize; 3]), usize>,
}

impl Writer {
    /// A register that is written from outside.
    pub fn register(&mut self, class: Class) -> usize {
        self.program.classes.push(class);
        self.program.classes.len() - 1
    }

    /// The register of a number.
    pub fn number(&mut self, value: f64) -> usize {
        let same = |(_, known): &&(usize, f64)| known.to_bits() == value.to_bits();
        if let Some((register, _)) = self.program.numbers.iter().find(same) {
            return *register;
        }
        let register = self.register(Class::Constant);
        self.program.numbers.push((register, value));
        register
    }

    /// The register of an expression whose names are all in the scope; `NaN` for others.
    pub fn expression(&mut self, expression: &Expression, scope: &Scope) -> usize {
        if let Some(value) = expression.value() {
            return self.number(value);
        }
        match &expression.node {
            Node::Number(value) => self.number(*value),
            Node::Name(name) => scope.get(name).copied().unwrap_or_else(|| self.number(f64::NAN)),
            Node::Apply(function, parts) => {
                let mut from = [0; 3];
                for (register, part) in from.iter_mut().zip(parts) {
                    *register = self.expression(part, scope);
                }
                self.operation(*function, from)
            }
        }
    }

    fn operation(&mut self, function: Function, from: [usize; 3]) -> usize {
        if let Some(register) = self.known.get(&(function, from)) {
            return *register;
        }
        let class = from[..function.arguments()].iter().map(|r| self.program.classes[*r]).max();
        let class = class.unwrap_or(Class::Constant);
        let to = self.register(class);
        self.program.operations[class as usize].push(Operation { function, to, from });
        self.known.insert((function, from), to);
        to
    }

    /// A register of its own for each state's result, which later operations read.
    pub fn results(&mut self, registers: Vec<usize>) -> Vec<usize> {
        let mut own: Vec<usize> = vec![];
        for register in registers {
            let is_own = |program: &Program| program.operations[Class::State as usize].iter().any(|o| o.to == register);
            let register = if is_own(&self.program) && !own.contains(&register) {
                register
            } else {
                let to = self.register(Class::State);
                let copy = Operation { function: Function::Copy, to, from: [register; 3] };
                self.program.operations[Class::State as usize].push(copy);
                to
            };
            own.push(register);
        }
        own.iter().for_each(|register| self.program.classes[*register] = Class::After);
        own
    }

    /// The operations of a single state as a chain from `before` to `now`: each acts on the result of the one before and on another
    /// register. None where they are no chain.
    pub fn chain(&self, before: usize, now: usize) -> Option<Vec<(Function, usize)>> {
        let mut last = before;
        let mut chain = vec![];
        for Operation { function, to, from: [a, b, _] } in &self.program.operations[Class::State as usize] {
            let others = [*a, *b].map(|register| self.program.classes[register] < Class::State);
            let other = match others {
                _ if function.arguments() != 2 => return None,
                [false, true] if *a == last => *b,
                [true, false] if *b == last && function.is_symmetric() => *a,
                _ => return None,
            };
            chain.push((*function, other));
            last = *to;
        }
        (last == now && !chain.is_empty()).then_some(chain)
    }

    /// What was written.
    pub fn finish(self) -> Program {
        self.program
    }
}

impl Program {
    /// Operations of a class.
    pub fn of(&self, class: Class) -> &[Operation] {
        &self.operations[class as usize]
    }

    /// Number of registers.
    pub fn registers(&self) -> usize {
        self.classes.len()
    }
}

/// Carries operations out on `span` of every register, where registers are `stride` apart.
#[inline]
pub fn run(operations: &[Operation], buffer: &mut [f64], stride: usize, span: Range<usize>) {
    for operation in operations {
        one(operation, buffer, stride, span.clone());
    }
}

#[inline]
fn one(operation: &Operation, buffer: &mut [f64], stride: usize, span: Range<usize>) {
    let (left, right) = buffer.split_at_mut(operation.to * stride);
    let to = &mut right[span.clone()];
    let from = |k: usize| &left[operation.from[k] * stride + span.start..operation.from[k] * stride + span.end];
    let (a, b) = (from(0), if operation.function.arguments() > 1 { from(1) } else { from(0) });
    match operation.function {
        Function::Add => two(to, a, b, |a, b| a + b),
        Function::Subtract => two(to, a, b, |a, b| a - b),
        Function::Multiply => two(to, a, b, |a, b| a * b),
        Function::Divide => two(to, a, b, |a, b| a / b),
        Function::Min => two(to, a, b, f64::min),
        Function::Max => two(to, a, b, f64::max),
        Function::If => {
            to.iter_mut().zip(a).zip(b).zip(from(2)).for_each(|(((to, a), b), c)| *to = chosen(*a, *b, *c));
        }
        function => match function.of_one() {
            Some(of) => to.iter_mut().zip(a).for_each(|(to, a)| *to = of(*a)),
            None => two(to, a, b, |a, b| function.of([a, b, 0.0])),
        },
    }
}

#[inline]
fn two(to: &mut [f64], a: &[f64], b: &[f64], of: impl Fn(f64, f64) -> f64) {
    to.iter_mut().zip(a).zip(b).for_each(|((to, a), b)| *to = of(*a, *b));
}
