"""Runs functions of the sources on Numbers. Calls are inlined, loops unrolled; conditions must be known or assumed."""
import operator

from reader import SourceError
from rounding import Number, Rounding, exactly

_SWIZZLES = {c: i for i, c in enumerate("xyzw")}
_ON_INTEGERS = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "%": operator.mod, "<": operator.lt, "==": operator.eq
}
# A condition, integer or text that the evaluation does not follow. Only an assumption decides it.
UNKNOWN = object()


class Vector(list):
    """Components, or any elements. Those that are assigned one by one, in their order, make a new one."""

    def __setitem__(self, index, value):
        if index == len(self):
            self.append(value)
        else:
            super().__setitem__(index, value)


class Matrix(Vector):
    """Columns, as in GLSL."""


class Returned(Exception):
    def __init__(self, value):
        self.value = value


def each(value, operation):
    """The value with an operation applied to each Number in it."""
    if isinstance(value, list):
        return type(value)(each(part, operation) for part in value)
    if isinstance(value, dict):
        return {name: each(part, operation) for name, part in value.items()}
    return operation(value) if isinstance(value, Number) else value


def pairwise(p, q, operation):
    """An operation on two numbers, or on each of a vector's and a number or the other vector's."""
    if [] in (p, q):
        raise ValueError("a variable has no value yet")
    if isinstance(p, Vector) and isinstance(q, Vector):
        return type(p)(pairwise(x, y, operation) for x, y in zip(p, q, strict=True))
    if isinstance(p, Vector):
        return type(p)(pairwise(x, q, operation) for x in p)
    if isinstance(q, Vector):
        return type(q)(pairwise(p, y, operation) for y in q)
    return operation(_real(p), _real(q))


def _real(value):
    return exactly(value) if isinstance(value, int) else value


def _fits(value, base):
    """Whether a value may be an argument for a parameter of a type."""
    if isinstance(value, Matrix):
        return base == "mat3" or base[0].isupper()
    if isinstance(value, Vector):
        return base.endswith(f"vec{len(value)}") or base[0].isupper()
    if isinstance(value, dict):
        return value.get("type", base) == base
    if isinstance(value, Number):
        return base in ("float", "double", "Real") or base[0].isupper()
    return True


class Evaluator:
    """Evaluates functions under a claim's conditions. All of these must be used.

    names: by the text of a variable, or of a call, of the function that is called, what takes the place of its value.
    A text is the name of a symbol: that of the value as computed; of a vector's components, with their numbers.
    contracts: by name, what takes the place of functions.
    assumptions: by the text of a condition, whether it holds.
    globals: by name, values of variables outside functions, and functions; they need not be used.

    What takes a place is a value, a Python function of the value or of the arguments, or an iterator that gives another
    of these each time, as often as the sources have it.

    values: by the text of a variable, the values that it had, before others took their places.
    variables: those of the function that has been called, at its end.
    compared: comparisons of Numbers: text, left, right.
    """

    def __init__(self, sources, arithmetic, *, names=(), contracts=(), assumptions=(), globals=()):
        self.sources, self.rounding = sources, Rounding(arithmetic)
        self.contracts, self.globals = dict(contracts), dict(globals)
        self.assumptions, self.names = (
            {text.replace(" ", ""): value for text, value in dict(given).items()} for given in (assumptions, names)
        )
        self.values, self.compared, self.variables = {}, [], {}
        self.called, self.used, self.precise = None, set(), False

    def call(self, name, *arguments, members=()):
        """The result of a function of the sources. `members`: those of its object."""
        self.called = name
        result, self.variables = self._run(self._function(name, arguments), arguments, dict(members))
        for text, other in (self.names | self.contracts | self.assumptions).items():
            if text not in self.used or (hasattr(other, "__next__") and next(other, None) is not None):
                raise SourceError(f"{name}: the sources have no use, or not enough, for the claim's '{text}'")
        return result

    def expression(self, owner, text, **variables):
        """The value of an expression that the function `owner` contains."""
        return self.settled(self.evaluate(self.sources.expression(owner, text), {"function": owner} | variables))

    def _function(self, name, arguments):
        def takes(function):
            bases = [base for base, _, _ in function.parameters]
            return len(bases) == len(arguments) and all(map(_fits, arguments, bases))

        return self.sources.function(name, takes)

    def _run(self, function, arguments, members):
        """The result of a function, or the members that a constructor initialises; and the values of its variables."""
        scope = members | {"function": function.name}
        for (_, name, _), value in zip(function.parameters, arguments):
            scope[name] = self._renamed(scope, name, value)
        outer, self.precise = self.precise, False
        made = {member: self.evaluate(value, scope) for member, value in function.initialised().items()}
        scope |= made
        result = self._returned(function.body, scope)
        self.precise = outer
        return made if result is None and made else result, scope

    def _returned(self, body, scope):
        try:
            self.execute(body, scope)
        except Returned as returned:
            return self.settled(returned.value)
        return None

    def settled(self, value):
        """The value with its sums rounded. Variables are, and what a function returns."""
        return each(value, self.rounding.settled)

    def _renamed(self, scope, text, value):
        """What a claim puts in the place of a value, or the value."""
        if scope["function"] != self.called:
            return value
        self.values.setdefault(text, []).append(value)
        if text not in self.names:
            return value
        other = self._in_place(self.names, text, value)
        if not isinstance(other, str):
            return other
        if isinstance(value, Vector):
            return type(value)(self.rounding.named(x, f"{other}{k}") for k, x in enumerate(value))
        return self.rounding.named(value, other)

    def _in_place(self, conditions, key, *arguments):
        self.used.add(key)
        other = conditions[key]
        if hasattr(other, "__next__"):
            other = next(other)
        return other(*arguments) if callable(other) else other

    # Statements

    def execute(self, node, scope):
        try:
            self._execute(node, scope)
        except (ArithmeticError, AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
            raise SourceError(f"{node.token.place}: not understood: {type(error).__name__}: {error}") from error

    def _execute(self, node, scope):
        parts = node.parts
        match node.kind:
            case "block":
                for part in parts:
                    self.execute(part, scope)
            case "declare":
                base, qualifiers = node.value
                outer, self.precise = self.precise, "precise" in qualifiers
                value = self._initial(node, base, scope)
                scope[node.name] = self._renamed(scope, node.name, self.settled(value))
                self.precise = outer
            case "assign":
                value = self.evaluate(parts[1], scope)
                if node.name != "=":
                    value = self._binary(node, node.name[0], self.evaluate(parts[0], scope), value)
                self._assign(parts[0], value, scope)
            case "evaluate":
                self.evaluate(parts[0], scope)
            case "if":
                for part in parts[1:2] if self.condition(parts[0], scope) else parts[2:]:
                    self.execute(part, scope)
            case "for":
                scope[node.name] = self.evaluate(parts[0], scope)
                while self.condition(parts[1], scope):
                    self.execute(parts[2], scope)
                    scope[node.name] += 1
            case "return":
                raise Returned(self.evaluate(parts[0], scope) if parts else None)
            case _:
                raise SourceError(f"{node.token.place}: '{node.kind}' is not understood here")

    def _initial(self, node, base, scope):
        """The value that a variable is declared with."""
        is_struct = base in self.sources.structs
        if not node.parts:
            return {"type": base} if is_struct else Vector()
        value = self.evaluate(node.parts[0], scope)
        return self._struct(base, value) if is_struct and node.parts[0].kind == "list" else value

    def _assign(self, target, value, scope):
        value = self._renamed(scope, target.text, self.settled(value))
        match target.kind:
            case "name":
                scope[target.name] = value
            case "member":
                holder = self._holder(target.parts[0], scope)
                holder[target.name if isinstance(holder, dict) else _SWIZZLES[target.name]] = value
            case "index":
                self._holder(target.parts[0], scope)[self.evaluate(target.parts[1], scope)] = value
            case _:
                raise SourceError(f"{target.token.place}: cannot assign to this")

    def _holder(self, node, scope):
        """The vector or struct of which an element or a member is assigned; a new vector where there was nothing."""
        if node.kind == "name":
            return scope.setdefault(node.name, Vector())
        holder = self._holder(node.parts[0], scope)
        if node.kind == "member":
            return holder.setdefault(node.name, Vector())
        index = self.evaluate(node.parts[1], scope)
        if index == len(holder):
            holder.append(Vector())
        return holder[index]

    # Expressions

    def condition(self, node, scope):
        if node.text in self.assumptions:
            return self._in_place(self.assumptions, node.text)
        value = self.evaluate(node, scope)
        if isinstance(value, int):
            return bool(value)
        raise SourceError(f"{node.token.place}: whether '{node.text}' holds is neither known nor assumed")

    def evaluate(self, node, scope):
        match node.kind:
            case "name":
                return self._variable(node, scope)
            case "number":
                value = self.sources.replaced.get(node.token, node.value)
                return value if isinstance(value, int) else exactly(value)
            case "closure":
                return lambda *arguments: self._returned(node.parts[0], scope | dict(zip(node.value, arguments)))
            case "choose":
                return self.evaluate(node.parts[1 if self.condition(node.parts[0], scope) else 2], scope)
            case "call":
                value = self._call(node, scope)
                named = node.text in self.names and scope["function"] == self.called
                return self._renamed(scope, node.text, self.settled(value)) if named else value
            case "method":  # of an object: only contracts know any
                return self._in_place(self.contracts, node.name, *(self.evaluate(p, scope) for p in node.parts[1:]))
            case "unary" if node.name == "&" and node.parts[0].kind == "index":  # a pointer to what is indexed
                holder, index = (self.evaluate(part, scope) for part in node.parts[0].parts)
                return holder[index:]
        values = [self.evaluate(part, scope) for part in node.parts]
        match node.kind:
            case "list":
                return Vector(values)
            case "binary":
                return self._binary(node, node.name, *values)
            case "unary" | "member" | "index" if values[0] is UNKNOWN:
                return UNKNOWN
            case "index":
                return values[0][values[1]]
            case "member":
                if isinstance(values[0], dict):
                    return values[0][node.name]
                picked = Vector(values[0][_SWIZZLES[c]] for c in node.name)
                return picked[0] if len(picked) == 1 else picked
            case "unary" if node.name == "-":
                return -values[0] if isinstance(values[0], int) else each(values[0], self.rounding.negated)
            case "unary" if node.name == "!" and isinstance(values[0], bool):
                return not values[0]
        raise SourceError(f"{node.token.place}: '{node.text}' is not understood here")

    def _variable(self, node, scope):
        name = node.name
        for variables in (scope, self.globals, {"true": True, "false": False}):
            if name in variables:
                return variables[name]
        if name in self.sources.constants:
            return self.evaluate(self.sources.constant(name), {"function": name})
        raise SourceError(f"{node.token.place}: '{name}' is not known")

    def _binary(self, node, name, p, q):
        if isinstance(p, int) and isinstance(q, int):
            return _ON_INTEGERS[name](p, q)
        if name in ("<", ">", "<=", ">=") and isinstance(p, Number) and isinstance(q, Number):
            self.compared.append((node.text, self.settled(p), self.settled(q)))
        if name not in ("+", "-", "*", "/") or p is UNKNOWN or q is UNKNOWN:
            return UNKNOWN
        if name == "*":
            return self._multiply(p, q)
        return pairwise(p, q, {"+": self._add, "-": self._subtract, "/": self.rounding.divide}[name])

    def _add(self, p, q):
        return self.rounding.add(p, q, self.precise)

    def _subtract(self, p, q):
        return self._add(p, self.rounding.negated(q))

    def _multiply(self, p, q):
        if isinstance(p, Matrix) and isinstance(q, Matrix):
            return Matrix(self._multiply(p, column) for column in q)
        if isinstance(p, Matrix) and isinstance(q, Vector):
            return Vector(self.dot(row, q) for row in zip(*p))
        if isinstance(p, Vector) and isinstance(q, Matrix):
            return Vector(self.dot(p, column) for column in q)
        return pairwise(p, q, self.rounding.multiply)

    def dot(self, p, q):
        first, *others = (self.rounding.multiply(_real(x), _real(y)) for x, y in zip(p, q, strict=True))
        for other in others:
            first = self._add(first, other)
        return first

    def cross(self, p, q):
        def minor(i, j):
            return self._subtract(self.rounding.multiply(p[i], q[j]), self.rounding.multiply(p[j], q[i]))

        return Vector([minor(1, 2), minor(2, 0), minor(0, 1)])

    # Calls

    def _call(self, node, scope):
        name = node.name.removeprefix("std::").removeprefix("radar::")
        arguments = [self.evaluate(part, scope) for part in node.parts]
        called = scope.get(node.name, self.globals.get(node.name))
        if callable(called):
            return called(*arguments)
        if node.name in self.contracts:
            return self._in_place(self.contracts, node.name, *map(self.settled, arguments))
        if node.name in self.sources.structs and node.name not in self.sources.functions:
            return self._struct(node.name, arguments)
        if name in _BUILT_IN and node.name not in self.sources.functions:
            return _BUILT_IN[name](self, *arguments)
        function = self._function(name, arguments)
        result, inner = self._run(function, arguments, {})
        for part, (_, parameter, is_out) in zip(node.parts, function.parameters):
            if is_out:
                self._assign(part, inner[parameter], scope)
        return result

    def _struct(self, name, values):
        return dict(zip(self.sources.structs[name], values, strict=True), type=name)

    def _vector(self, n, values):
        flat = [x for value in values for x in (value if isinstance(value, Vector) else [_real(value)])]
        return Vector(flat * n if len(flat) == 1 else flat)

    def _less_than_equal(self, x, y):
        self.compared += [("lessThanEqual", self.settled(p), self.settled(q)) for p, q in zip(x, y, strict=True)]
        return UNKNOWN


_BUILT_IN = {
    "abs": lambda e, x: each(_real(x), e.rounding.absolute),
    "min": lambda e, x, y: pairwise(x, y, e.rounding.minimum),
    "max": lambda e, x, y: pairwise(x, y, e.rounding.maximum),
    "dot": Evaluator.dot,
    "cross": Evaluator.cross,
    "transpose": lambda e, m: Matrix(map(Vector, zip(*m))),
    "mat3": lambda e, *columns: Matrix(columns),
    "vec2": lambda e, *values: e._vector(2, values),
    "vec3": lambda e, *values: e._vector(3, values),
    "dvec3": lambda e, *values: e._vector(3, values),
    "float": lambda e, x: _real(x),
    "double": lambda e, x: _real(x),
    "all": lambda e, conditions: UNKNOWN,
    "lessThanEqual": Evaluator._less_than_equal,
}
