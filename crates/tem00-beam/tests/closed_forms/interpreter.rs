//! A tree walker over the intermediate form of naga, for functions of `f32` numbers and structs.
//!
//! It knows what plain shader functions are made of and stops at everything else. All arithmetic is
//! that of `f32`, in the order of the source.

use std::collections::HashMap;

use naga::{
    BinaryOperator, Block, Constant, Expression, Function, Handle, Literal, LocalVariable,
    MathFunction, Module, Range, Statement, Type, TypeInner, UnaryOperator,
};

/// A number, a truth value, or the components of a vector or members of a struct.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Number(f32),
    Truth(bool),
    Composite(Vec<Self>),
}

impl Value {
    fn number(&self) -> f32 {
        match self {
            Self::Number(x) => *x,
            other => panic!("{other:?} is not a number"),
        }
    }

    fn truth(&self) -> bool {
        match self {
            Self::Truth(x) => *x,
            other => panic!("{other:?} is not a truth value"),
        }
    }

    fn component(&self, index: u32) -> Self {
        match self {
            Self::Composite(values) => values[index as usize].clone(),
            other => panic!("{other:?} has no components"),
        }
    }

    /// Returns all numbers, members in order.
    pub(crate) fn flatten(&self) -> Vec<f32> {
        match self {
            Self::Composite(values) => values.iter().flat_map(Self::flatten).collect(),
            scalar => vec![scalar.number()],
        }
    }
}

impl From<&[f32]> for Value {
    fn from(numbers: &[f32]) -> Self {
        Self::Composite(numbers.iter().copied().map(Self::Number).collect())
    }
}

/// Returns the type of the name.
pub(crate) fn type_of(module: &Module, name: &str) -> Handle<Type> {
    let named = |(_, ty): &(Handle<Type>, &Type)| ty.name.as_deref() == Some(name);
    let found = module.types.iter().find(named);
    found.unwrap_or_else(|| panic!("no type {name}")).0
}

/// Reads a value of the type from memory, given as words of four bytes.
pub(crate) fn load(module: &Module, ty: Handle<Type>, words: &[f32]) -> Value {
    match &module.types[ty].inner {
        TypeInner::Scalar(_) => Value::Number(words[0]),
        TypeInner::Vector { size, .. } => (&words[..*size as usize]).into(),
        TypeInner::Struct { members, .. } => Value::Composite(
            members
                .iter()
                .map(|member| load(module, member.ty, &words[member.offset as usize / 4..]))
                .collect(),
        ),
        other => panic!("cannot load {other:?}"),
    }
}

/// Calls the function of the name.
pub(crate) fn call(module: &Module, name: &str, arguments: &[Value]) -> Value {
    let named = |(_, f): &(Handle<Function>, &Function)| f.name.as_deref() == Some(name);
    let found = module.functions.iter().find(named);
    let (_, function) = found.unwrap_or_else(|| panic!("no function {name}"));
    Frame::new(module, function, arguments)
        .run(&function.body)
        .unwrap_or_else(|| panic!("{name} returns nothing"))
}

/// A function being executed.
struct Frame<'a> {
    module: &'a Module,
    function: &'a Function,
    arguments: &'a [Value],
    locals: HashMap<Handle<LocalVariable>, Value>,
    /// What has been emitted, and the results of calls, by expression.
    values: Vec<Option<Value>>,
}

impl<'a> Frame<'a> {
    fn new(module: &'a Module, function: &'a Function, arguments: &'a [Value]) -> Self {
        assert_eq!(function.arguments.len(), arguments.len(), "arguments");
        let mut frame = Self {
            module,
            function,
            arguments,
            locals: HashMap::new(),
            values: vec![None; function.expressions.len()],
        };
        for (handle, local) in function.local_variables.iter() {
            let value = match local.init {
                Some(init) => frame.value(init),
                None => zero(module, local.ty),
            };
            frame.locals.insert(handle, value);
        }
        frame
    }

    /// Executes the statements up to a return, and returns its value.
    fn run(&mut self, block: &Block) -> Option<Value> {
        block.iter().find_map(|statement| self.execute(statement))
    }

    /// Executes a statement, and returns a value if it is a return.
    fn execute(&mut self, statement: &Statement) -> Option<Value> {
        match statement {
            Statement::Emit(range) => self.emit(range.clone()),
            Statement::Block(block) => return self.run(block),
            Statement::If {
                condition,
                accept,
                reject,
            } => {
                let condition = self.value(*condition).truth();
                return self.run(if condition { accept } else { reject });
            }
            Statement::Return { value: Some(value) } => return Some(self.value(*value)),
            Statement::Store { pointer, value } => {
                let value = self.value(*value);
                *self.place(*pointer) = value;
            }
            Statement::Call {
                function,
                arguments,
                result: Some(result),
            } => {
                let arguments: Vec<_> = arguments.iter().map(|a| self.value(*a)).collect();
                let callee = &self.module.functions[*function];
                let value = Frame::new(self.module, callee, &arguments).run(&callee.body);
                self.values[result.index()] = value;
            }
            other => panic!("unknown statement {other:?}"),
        }
        None
    }

    fn emit(&mut self, range: Range<Expression>) {
        for handle in range {
            // Pointers are followed when they are loaded or stored to.
            if !self.is_pointer(handle) {
                let value = self.evaluate(handle);
                self.values[handle.index()] = Some(value);
            }
        }
    }

    fn is_pointer(&self, handle: Handle<Expression>) -> bool {
        match self.function.expressions[handle] {
            Expression::LocalVariable(_) => true,
            Expression::AccessIndex { base, .. } => self.is_pointer(base),
            _ => false,
        }
    }

    /// Returns the variable, or the part of it, that an expression points to.
    fn place(&mut self, pointer: Handle<Expression>) -> &mut Value {
        match self.function.expressions[pointer] {
            Expression::LocalVariable(local) => self.locals.get_mut(&local).expect("a local"),
            Expression::AccessIndex { base, index } => match self.place(base) {
                Value::Composite(values) => &mut values[index as usize],
                other => panic!("{other:?} has no components"),
            },
            ref other => panic!("unknown pointer {other:?}"),
        }
    }

    /// Returns a value that has been emitted, or need not be.
    fn value(&mut self, handle: Handle<Expression>) -> Value {
        match &self.values[handle.index()] {
            Some(value) => value.clone(),
            None => self.evaluate(handle),
        }
    }

    fn evaluate(&mut self, handle: Handle<Expression>) -> Value {
        match &self.function.expressions[handle] {
            Expression::Literal(literal) => literal_value(*literal),
            Expression::Constant(constant) => constant_value(self.module, *constant),
            Expression::ZeroValue(ty) => zero(self.module, *ty),
            Expression::FunctionArgument(index) => self.arguments[*index as usize].clone(),
            Expression::Load { pointer } => self.place(*pointer).clone(),
            Expression::AccessIndex { base, index } => self.value(*base).component(*index),
            Expression::Compose { ty, components } => self.compose(*ty, components),
            Expression::Splat { size, value } => {
                Value::Composite(vec![self.value(*value); *size as usize])
            }
            Expression::Swizzle {
                size,
                vector,
                pattern,
            } => {
                let vector = self.value(*vector);
                let pattern = pattern[..*size as usize].iter();
                Value::Composite(pattern.map(|&i| vector.component(i as u32)).collect())
            }
            Expression::Select {
                condition,
                accept,
                reject,
            } => {
                let condition = self.value(*condition).truth();
                self.value(if condition { *accept } else { *reject })
            }
            operation => self.operate(operation),
        }
    }

    fn compose(&mut self, ty: Handle<Type>, components: &[Handle<Expression>]) -> Value {
        let parts: Vec<_> = components.iter().map(|c| self.value(*c)).collect();
        match &self.module.types[ty].inner {
            TypeInner::Vector { .. } => {
                let numbers: Vec<_> = parts.iter().flat_map(Value::flatten).collect();
                numbers.as_slice().into()
            }
            TypeInner::Struct { .. } => Value::Composite(parts),
            other => panic!("cannot compose {other:?}"),
        }
    }

    fn operate(&mut self, expression: &Expression) -> Value {
        match expression {
            Expression::Unary { op, expr } => unary(*op, &self.value(*expr)),
            Expression::Binary { op, left, right } => {
                binary(*op, &self.value(*left), &self.value(*right))
            }
            Expression::Math {
                fun,
                arg,
                arg1,
                arg2: None,
                arg3: None,
            } => {
                let second = arg1.map(|handle| self.value(handle));
                math(*fun, &self.value(*arg), second.as_ref())
            }
            other => panic!("unknown expression {other:?}"),
        }
    }
}

fn constant_value(module: &Module, constant: Handle<Constant>) -> Value {
    match module.global_expressions[module.constants[constant].init] {
        Expression::Literal(literal) => literal_value(literal),
        ref other => panic!("unknown constant {other:?}"),
    }
}

fn literal_value(literal: Literal) -> Value {
    match literal {
        Literal::F32(x) => Value::Number(x),
        Literal::Bool(x) => Value::Truth(x),
        other => panic!("unknown literal {other:?}"),
    }
}

fn zero(module: &Module, ty: Handle<Type>) -> Value {
    match &module.types[ty].inner {
        TypeInner::Scalar(scalar) if scalar.kind == naga::ScalarKind::Bool => Value::Truth(false),
        TypeInner::Scalar(_) => Value::Number(0.0),
        TypeInner::Vector { size, .. } => {
            Value::Composite(vec![Value::Number(0.0); *size as usize])
        }
        TypeInner::Struct { members, .. } => {
            Value::Composite(members.iter().map(|m| zero(module, m.ty)).collect())
        }
        other => panic!("no zero of {other:?}"),
    }
}

/// Applies a function to numbers, or to each component.
fn map(value: &Value, f: &impl Fn(f32) -> f32) -> Value {
    match value {
        Value::Composite(values) => Value::Composite(values.iter().map(|v| map(v, f)).collect()),
        scalar => Value::Number(f(scalar.number())),
    }
}

/// Applies a function to two numbers, to each pair of components, or to a number and each component.
fn zip(left: &Value, right: &Value, f: &impl Fn(f32, f32) -> f32) -> Value {
    match (left, right) {
        (Value::Composite(a), Value::Composite(b)) => {
            assert_eq!(a.len(), b.len(), "components");
            Value::Composite(a.iter().zip(b).map(|(a, b)| zip(a, b, f)).collect())
        }
        (Value::Composite(_), scalar) => map(left, &|x| f(x, scalar.number())),
        (scalar, _) => map(right, &|y| f(scalar.number(), y)),
    }
}

fn unary(op: UnaryOperator, value: &Value) -> Value {
    match op {
        UnaryOperator::Negate => map(value, &|x| -x),
        UnaryOperator::LogicalNot => Value::Truth(!value.truth()),
        other => panic!("unknown operator {other:?}"),
    }
}

fn binary(op: BinaryOperator, left: &Value, right: &Value) -> Value {
    let compare = |f: fn(&f32, &f32) -> bool| Value::Truth(f(&left.number(), &right.number()));
    match op {
        BinaryOperator::Add => zip(left, right, &|a, b| a + b),
        BinaryOperator::Subtract => zip(left, right, &|a, b| a - b),
        BinaryOperator::Multiply => zip(left, right, &|a, b| a * b),
        BinaryOperator::Divide => zip(left, right, &|a, b| a / b),
        BinaryOperator::Equal => compare(f32::eq),
        BinaryOperator::NotEqual => compare(f32::ne),
        BinaryOperator::Less => compare(f32::lt),
        BinaryOperator::LessEqual => compare(f32::le),
        BinaryOperator::Greater => compare(f32::gt),
        BinaryOperator::GreaterEqual => compare(f32::ge),
        other => panic!("unknown operator {other:?}"),
    }
}

fn math(fun: MathFunction, first: &Value, second: Option<&Value>) -> Value {
    match (fun, second) {
        (MathFunction::Abs, None) => map(first, &f32::abs),
        (MathFunction::Atan, None) => map(first, &f32::atan),
        (MathFunction::Exp, None) => map(first, &f32::exp),
        (MathFunction::Sqrt, None) => map(first, &f32::sqrt),
        (MathFunction::Dot, Some(second)) => {
            let products = zip(first, second, &|a, b| a * b).flatten();
            Value::Number(products.into_iter().sum())
        }
        other => panic!("unknown function {other:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs `fn f(x: f32, y: f32) -> …` with this result and body on x = 3, y = −0.5.
    fn run(result: &str, body: &str) -> Vec<f32> {
        let source = format!(
            "struct Pair {{ a: vec2<f32>, b: f32 }}
             const THIRD = 1.0 / 3.0;
             fn twice(x: f32) -> f32 {{ return 2.0 * x; }}
             fn f(x: f32, y: f32) -> {result} {{ {body} }}"
        );
        let module = naga::front::wgsl::parse_str(&source).unwrap();
        let arguments = [Value::Number(3.0), Value::Number(-0.5)];
        call(&module, "f", &arguments).flatten()
    }

    #[test]
    fn arithmetic_is_that_of_single_precision_in_order() {
        let cases = [
            ("return x + y * x - y / x;", 3.0 - 1.5 + 0.5 / 3.0),
            ("return -x * y;", 1.5),
            ("return x * THIRD;", 1.0),
            ("return x + 1e-7 - x;", 0.0),
            ("return twice(x) + twice(twice(y));", 4.0),
            ("return exp(y) * sqrt(x) + abs(y) + atan(x);", {
                (-0.5_f32).exp() * 3_f32.sqrt() + 0.5 + 3_f32.atan()
            }),
        ];
        for (body, expected) in cases {
            let got = run("f32", body);
            // Both sides are the same rounded operations.
            assert_eq!(got, [expected], "{body}");
        }
    }

    #[test]
    fn branches_comparisons_and_logic_choose_one_way() {
        let cases = [
            ("if x > y { return 1.0; } return 2.0;", 1.0),
            ("if x <= y { return 1.0; } else { return 2.0; }", 2.0),
            ("if !(x >= 3.0) { return 1.0; } return 2.0;", 2.0),
            ("if x < 0.0 || y < 0.0 { return 1.0; } return 2.0;", 1.0),
            ("if x < 0.0 && y < 0.0 { return 1.0; } return 2.0;", 2.0),
            (
                "if x == 3.0 { if y != -0.5 { return 1.0; } } return 2.0;",
                2.0,
            ),
            ("if x < 3.0 || x > 3.0 { return 1.0; } return 2.0;", 2.0),
            ("if x <= 3.0 && x >= 3.0 { return 1.0; } return 2.0;", 1.0),
            ("return select(1.0, 2.0, x < 0.0);", 1.0),
            ("return select(1.0, 2.0, x > 0.0);", 2.0),
        ];
        for (body, expected) in cases {
            assert_eq!(run("f32", body), [expected], "{body}");
        }
    }

    #[test]
    fn vectors_structs_and_variables_keep_their_parts() {
        let cases = [
            (
                "vec3<f32>",
                "return vec3(vec2(x, y), 7.0).zyx;",
                vec![7.0, -0.5, 3.0],
            ),
            (
                "vec2<f32>",
                "return 2.0 * vec2(x, y) / vec2(y);",
                vec![-12.0, 2.0],
            ),
            (
                "f32",
                "return dot(vec3(x, y, 1.0), vec3(1.0, 2.0, 3.0));",
                vec![5.0],
            ),
            ("f32", "return Pair(vec2(x, y), 1.0).a.y;", vec![-0.5]),
            ("Pair", "return Pair();", vec![0.0; 3]),
            (
                "Pair",
                "var pair: Pair; pair.b = x; pair.a = vec2(y); pair.a.x = pair.b; return pair;",
                vec![3.0, -0.5, 3.0],
            ),
            (
                "f32",
                "var z = x; { let old = z; z = y; z = old + z; } return z;",
                vec![2.5],
            ),
        ];
        for (result, body, expected) in cases {
            assert_eq!(run(result, body), expected, "{body}");
        }
    }

    #[test]
    fn members_are_loaded_from_their_offsets() {
        let source = "struct Inner { a: f32, b: f32 }
                      struct Outer { v: vec3<f32>, s: f32, pad: vec2<f32>, inner: Inner }";
        let module = naga::front::wgsl::parse_str(source).unwrap();
        let words: Vec<f32> = (0..8_u8).map(f32::from).collect();
        let value = load(&module, type_of(&module, "Outer"), &words);
        assert_eq!(value.flatten(), words, "no gaps in this struct");
        let inner = value.component(3);
        assert_eq!(inner, [6.0, 7.0].as_slice().into(), "the last member");
    }

    #[test]
    #[should_panic(expected = "unknown function (Sin")]
    fn an_unknown_function_stops() {
        run("f32", "return sin(x);");
    }

    #[test]
    #[should_panic(expected = "unknown statement Loop")]
    fn an_unknown_statement_stops() {
        run("f32", "loop { if x > y { break; } } return x;");
    }

    #[test]
    #[should_panic(expected = "unknown expression As")]
    fn an_unknown_expression_stops() {
        run("f32", "return f32(u32(x));");
    }
}
