//! Counts the operations of each kernel from its parsed source. These counts are an estimate of speed that
//! needs no GPU.

use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{
    BinaryOperator, Block, Expression, Function, Handle, MathFunction, Module, ScalarKind, Statement,
    TypeInner, UnaryOperator,
};

use crate::device::kernel::shader_source;
use crate::device::precision::{Arithmetic, PassOrder, kernel_files};

/// Operations on single numbers.
#[derive(Clone, Copy, Default)]
struct Cost {
    /// All but the slow ones.
    simple: usize,
    /// The float additions and multiplications among them, for which GPUs have the most units.
    of_floats: usize,
    /// Divisions and square roots of floats, divisions of integers: each takes at least as long as ten
    /// simple ones.
    slow: usize,
}

impl Cost {
    fn plus(self, other: Self) -> Self {
        Self {
            simple: self.simple + other.simple,
            of_floats: self.of_floats + other.of_floats,
            slow: self.slow + other.slow,
        }
    }

    fn times(self, count: usize) -> Self {
        Self { simple: self.simple * count, of_floats: self.of_floats * count, slow: self.slow * count }
    }

    fn max(self, other: Self) -> Self {
        if self.simple + 10 * self.slow > other.simple + 10 * other.slow { self } else { other }
    }
}

/// A shader, with the number of iterations of the loops of each function.
struct Counter<'a> {
    module: Module,
    info: ModuleInfo,
    iterations: &'a dyn Fn(&str) -> usize,
}

impl Counter<'_> {
    fn function(&self, function: &Function, info: &FunctionInfo) -> Cost {
        let name = function.name.as_deref().unwrap_or_default();
        self.block(&function.body, function, info, (self.iterations)(name))
    }

    fn block(&self, block: &Block, function: &Function, info: &FunctionInfo, iterations: usize) -> Cost {
        let inner = |block: &Block| self.block(block, function, info, iterations);
        let statement = |statement: &Statement| match statement {
            Statement::Emit(range) => {
                let costs = range.clone().map(|handle| self.expression(handle, function, info));
                costs.fold(Cost::default(), Cost::plus)
            }
            Statement::Block(block) => inner(block),
            Statement::If { accept, reject, .. } => inner(accept).max(inner(reject)),
            Statement::Loop { body, continuing, .. } => inner(body).plus(inner(continuing)).times(iterations),
            Statement::Call { function, .. } => {
                let (called, info) = (&self.module.functions[*function], &self.info[*function]);
                // The first is called once in hundreds of times, the second only for vertices with copies.
                let is_rare = matches!(called.name.as_deref(), Some("long_arccosine" | "position_of_copy"));
                if is_rare { Cost::default() } else { self.function(called, info) }
            }
            _ => Cost::default(),
        };
        let mut total = Cost::default();
        for (at, found) in block.iter().enumerate() {
            // The rest of the block runs only if the early return is not taken.
            if let Statement::If { accept, reject, .. } = found
                && accept.last().is_some_and(|last| matches!(last, Statement::Return { .. }))
            {
                let rest: Block = block[at + 1..].to_vec().into();
                return total.plus(inner(accept).max(inner(reject).plus(inner(&rest))));
            }
            total = total.plus(statement(found));
        }
        total
    }

    fn expression(&self, handle: Handle<Expression>, function: &Function, info: &FunctionInfo) -> Cost {
        let inner = info[handle].ty.inner_with(&self.module.types);
        let (components, kind) = match *inner {
            TypeInner::Vector { size, scalar } => (size as usize, scalar.kind),
            TypeInner::Scalar(scalar) => (1, scalar.kind),
            _ => (1, ScalarKind::Bool),
        };
        let is_slow = match function.expressions[handle] {
            Expression::Binary { op: BinaryOperator::Divide | BinaryOperator::Modulo, .. } => true,
            Expression::Math { fun: MathFunction::Sqrt | MathFunction::InverseSqrt, .. } => true,
            Expression::Math { fun: MathFunction::Dot, .. } => {
                return Cost { simple: 5, of_floats: 5, slow: 0 };
            }
            Expression::As { convert: None, .. } => return Cost::default(),
            // GPUs negate operands for free.
            Expression::Unary { op: UnaryOperator::Negate, .. } if kind == ScalarKind::Float => {
                return Cost::default();
            }
            Expression::Binary { .. }
            | Expression::Unary { .. }
            | Expression::Select { .. }
            | Expression::Math { .. }
            | Expression::As { .. } => false,
            _ => return Cost::default(),
        };
        // One instruction combines two conditions.
        let simple = if kind == ScalarKind::Bool && components == 1 { 1 } else { components };
        let is_sum_or_product = matches!(
            function.expressions[handle],
            Expression::Binary {
                op: BinaryOperator::Add | BinaryOperator::Subtract | BinaryOperator::Multiply,
                ..
            }
        );
        let of_floats = if is_sum_or_product && kind == ScalarKind::Float { components } else { 0 };
        if is_slow {
            Cost { slow: components, ..Cost::default() }
        } else {
            Cost { simple, of_floats, slow: 0 }
        }
    }
}

/// The cost of one item of a kernel. `iterations`: of the loops of each function.
fn cost_of_item(arithmetic: Arithmetic, own: &[&'static str], iterations: &dyn Fn(&str) -> usize) -> Cost {
    let source = shader_source(&kernel_files(arithmetic, PassOrder::First, own));
    let module = naga::front::wgsl::parse_str(&source).expect("a valid shader");
    let mut validator = naga::valid::Validator::new(Default::default(), naga::valid::Capabilities::empty());
    let info = validator.validate(&module).expect("a valid shader");
    let counter = Counter { module, info, iterations };
    let run = counter.module.functions.iter().find(|(_, function)| function.name.as_deref() == Some("run"));
    let (handle, function) = run.expect("a kernel's function");
    counter.function(function, &counter.info[handle])
}

#[test]
fn operations_are_as_many_as_the_notes_say() {
    use crate::mikktspace::passes::{CORNER_TERMS, DERIVATIVES, EVALUATE};
    use crate::plan::shaders::{GATHER, TERMS};
    // A large regular mesh has six triangles at a vertex.
    let of_vertex = |name: &str| if name == "run" { 6 } else { 3 };
    let of_triangle = |_: &str| 3;
    let costs = |arithmetic| {
        let of_triangles = [TERMS, DERIVATIVES.files, CORNER_TERMS.files]
            .map(|own| cost_of_item(arithmetic, own, &of_triangle));
        let of_vertices = [GATHER, EVALUATE.files].map(|own| cost_of_item(arithmetic, own, &of_vertex));
        let all = [&of_triangles[..], &of_vertices].concat();
        all.iter().map(|cost| (cost.simple, cost.of_floats, cost.slow)).collect()
    };
    let exact: Vec<_> = costs(Arithmetic::Exact);
    let fast: Vec<_> = costs(Arithmetic::Fast);
    assert_eq!(exact, [(1_989, 365, 13), (654, 73, 4), (2_269, 414, 15), (326, 52, 3), (1_588, 270, 10)]);
    assert_eq!(fast, [(519, 272, 14), (155, 47, 6), (691, 303, 15), (163, 43, 3), (626, 244, 10)]);
}
