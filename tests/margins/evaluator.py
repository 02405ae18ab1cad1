"""Runs functions of the sources on Numbers. Calls are inlined, loops unrolled; conditions must be known or assumed."""
from reader import SourceError, text_of
from rounding import Number, Rounding, exactly

_SWIZZLES = {c: i for i, c in enumerate("xyzw")}


class Unknown:
    """A condition, integer or text that the evaluation does not follow. Only an assumption decides it."""


UNKNOWN = Unknown()


class Vector(list):
    pass


class Matrix(list):
    """Columns, as in GLSL."""


class Returned(Exception):
    def __init__(self, value):
        self.value = value


class Evaluator:
    """Evaluates functions under a claim's conditions; all of these must be used, or check_used() stops.

    contracts: by name, Python functions that take the place of functions; they get this evaluator and the arguments.
    assumptions: by the text of a condition, whether it holds.
    names: by "function.variable", or by "function.call(...)" for a call in it, a Python function from the variable's
    value to the one to go on with.
    replaced: by token, other values of literals.
    conversions: like contracts, but they need not be used.
    globals: by name, values of variables outside functions.
    """

    def __init__(
        self,
        sources,
        arithmetic,
        *,
        contracts=None,
        assumptions=None,
        names=None,
        replaced=None,
        globals=None,
        conversions=None,
    ):
        self.sources, self.rounding = sources, Rounding(arithmetic)
        self.contracts, self.assumptions, self.names = contracts or {}, assumptions or {}, names or {}
        self.replaced, self.globals, self.conversions = replaced or {}, globals or {}, conversions or {}
        self.used = set()
        self.compared = []  # comparisons of Numbers: text, left, right
        self.precise = False

    def check_used(self):
        for what, entries in (("contract", self.contracts), ("assumption", self.assumptions), ("name", self.names)):
            for entry in entries:
                if (what, entry) not in self.used:
                    raise SourceError(f"nothing in the sources corresponds to the claim's {what} '{entry}'")

    # ---- functions

    def call(self, name, *arguments, types=None):
        """Calls a function of the sources. `types`: those of its parameters, where there are several of the name."""
        function = self.sources.function(
            name,
            lambda f: len(f.parameters) == len(arguments)
            and (types is None or tuple(p[0] for p in f.parameters) == tuple(types))
            and all(self._fits(value, p[0]) for value, p in zip(arguments, f.parameters)),
        )
        result, _ = self.run(function, arguments)
        return result

    @staticmethod
    def _fits(value, base):
        if isinstance(value, Matrix):
            return base == "mat3" or base[0].isupper()
        if isinstance(value, Vector):
            return base[0].isupper() or (base[-4:-1] in ("vec", "dvec") and base.endswith(f"vec{len(value)}"))
        if isinstance(value, dict):
            return value.get("type", base) == base
        if isinstance(value, Number):
            return base in ("float", "double", "Real") or base[0].isupper()
        return True

    def run(self, function, arguments, members=None):
        """The result of a function, and the values of its variables. `members`: those of its object."""
        scope = {p[1]: value for p, value in zip(function.parameters, arguments)}
        scope |= members or {}
        scope["function"] = function.name
        for parameter in function.parameters:
            self._name(scope, parameter[1])
        outer, self.precise = self.precise, False
        try:
            self.execute(self.sources.body(function), scope)
            result = None
        except Returned as returned:
            result = self.settled(returned.value)
        self.precise = outer
        return result, scope

    def settled(self, value):
        """The value with its sums rounded. Variables are, and what a function returns."""
        if isinstance(value, dict):
            return {k: self.settled(v) for k, v in value.items()}
        if isinstance(value, list) and not isinstance(value, (Vector, Matrix)):
            return [self.settled(v) for v in value]
        return self._each(value, self.rounding.settled)

    def _name(self, scope, variable):
        entry = f"{scope['function']}.{variable}"
        if entry in self.names:
            self.used.add(("name", entry))
            scope[variable] = self.names[entry](scope.get(variable))

    # ---- statements

    def execute(self, node, scope):
        try:
            self._execute(node, scope)
        except (ArithmeticError, AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
            raise SourceError(f"{node.place}: not understood: {type(error).__name__}: {error}") from error

    def _execute(self, node, scope):
        kind = node.kind
        if kind == "block":
            for part in node.parts:
                self.execute(part, scope)
        elif kind == "declare":
            base, dimensions, qualifiers = node.value
            outer, self.precise = self.precise, "precise" in qualifiers
            value = self.evaluate(node.parts[0], scope) if node.parts else self.blank(base, dimensions, scope)
            if base in self.sources.structs and isinstance(value, list) and node.parts and node.parts[0].kind == "list":
                value = self._struct(node, base, value)
            scope[node.name] = self.settled(value)
            self.precise = outer
            self._name(scope, node.name)
        elif kind == "assign":
            value = self.evaluate(node.parts[1], scope)
            if node.name != "=":
                value = self.binary(node, node.name[0], self.evaluate(node.parts[0], scope), value)
            self.assign(node.parts[0], value, scope)
        elif kind == "evaluate":
            self.evaluate(node.parts[0], scope)
        elif kind == "if":
            if self.condition(node.parts[0], scope):
                self.execute(node.parts[1], scope)
            elif len(node.parts) > 2:
                self.execute(node.parts[2], scope)
        elif kind == "for":
            scope[node.name] = self.evaluate(node.parts[0], scope)
            while self.condition(node.parts[1], scope):
                self.execute(node.parts[2], scope)
                scope[node.name] += 1
        elif kind == "return":
            raise Returned(self.evaluate(node.parts[0], scope) if node.parts else None)
        else:
            raise SourceError(f"{node.place}: '{kind}' is not understood here")

    def blank(self, base, dimensions, scope):
        """A variable without a value."""
        if dimensions:
            return [self.blank(base, dimensions[1:], scope) for _ in range(self.evaluate(dimensions[0], scope))]
        if base in self.sources.structs:
            return {"type": base}
        if base in ("vec3", "dvec3", "LaneVec", "Vector"):
            return Vector([None] * 3)
        return None

    def assign(self, target, value, scope):
        value = self.settled(value)
        if target.kind == "name":
            scope[target.name] = value
            self._name(scope, target.name)
            return
        entry = f"{scope['function']}.{text_of(target)}"
        if entry in self.names:
            self.used.add(("name", entry))
            value = self.names[entry](value)
        if target.kind == "member":
            holder = self.evaluate(target.parts[0], scope)
            holder[target.name if isinstance(holder, dict) else _SWIZZLES[target.name]] = value
        elif target.kind == "index":
            self.evaluate(target.parts[0], scope)[self.evaluate(target.parts[1], scope)] = value
        else:
            raise SourceError(f"{target.place}: cannot assign to this")

    # ---- expressions

    def condition(self, node, scope):
        text = text_of(node)
        if text in self.assumptions:
            self.used.add(("assumption", text))
            return self.assumptions[text]
        value = self.evaluate(node, scope)
        if isinstance(value, (bool, int)):
            return bool(value)
        raise SourceError(f"{node.place}: whether '{text}' holds is neither known nor assumed")

    def evaluate(self, node, scope):
        value = getattr(self, f"_evaluate_{node.kind}")(node, scope)
        if node.kind == "call":
            entry = f"{scope['function']}.{text_of(node)}"
            if entry in self.names:
                self.used.add(("name", entry))
                value = self.names[entry](self.settled(value))
        return value

    def _evaluate_name(self, node, scope):
        name = node.name
        if name in scope:
            if scope[name] is None:
                raise SourceError(f"{node.place}: '{name}' has no value yet")
            return scope[name]
        if name in self.globals:
            return self.globals[name]
        if name in self.sources.constants:
            return self.evaluate(self.sources.constant(name), {"function": name})
        if name in ("true", "false"):
            return name == "true"
        raise SourceError(f"{node.place}: '{name}' is not known")

    def _evaluate_number(self, node, scope):
        value = self.replaced.get(node.token, node.value)
        return value if isinstance(value, int) else exactly(value)

    def _evaluate_closure(self, node, scope):
        def call(*arguments):
            inner = scope | dict(zip(node.value, arguments))
            try:
                self.execute(node.parts[0], inner)
            except Returned as returned:
                return self.settled(returned.value)
            raise SourceError(f"{node.place}: nothing is returned")

        return call

    def _evaluate_choose(self, node, scope):
        return self.evaluate(node.parts[1 if self.condition(node.parts[0], scope) else 2], scope)

    def _evaluate_list(self, node, scope):
        return Vector(self.evaluate(part, scope) for part in node.parts)

    def _evaluate_member(self, node, scope):
        holder = self.evaluate(node.parts[0], scope)
        if isinstance(holder, dict):
            if node.name not in holder:
                raise SourceError(f"{node.place}: no value for member '{node.name}'")
            return holder[node.name]
        if isinstance(holder, Vector) and set(node.name) <= set(_SWIZZLES):
            picked = [holder[_SWIZZLES[c]] for c in node.name]
            return picked[0] if len(picked) == 1 else Vector(picked)
        if isinstance(holder, Unknown):
            return UNKNOWN
        raise SourceError(f"{node.place}: member '{node.name}' is not understood")

    def _evaluate_index(self, node, scope):
        holder, index = self.evaluate(node.parts[0], scope), self.evaluate(node.parts[1], scope)
        if isinstance(holder, Unknown):
            return UNKNOWN
        return holder[index]

    def _evaluate_unary(self, node, scope):
        if node.name == "&" and node.parts[0].kind == "index":  # a pointer to an element, which is indexed
            holder, index = (self.evaluate(part, scope) for part in node.parts[0].parts)
            return holder[index:]
        value = self.evaluate(node.parts[0], scope)
        if node.name == "-":
            return -value if isinstance(value, int) else self._each(value, self.rounding.negated)
        if node.name == "!":
            return not value if isinstance(value, bool) else UNKNOWN
        return value

    def _evaluate_binary(self, node, scope):
        return self.binary(node, node.name, self.evaluate(node.parts[0], scope), self.evaluate(node.parts[1], scope))

    def binary(self, node, operation, p, q):
        if isinstance(p, int) and isinstance(q, int):
            return {
                "+": lambda: p + q,
                "-": lambda: p - q,
                "*": lambda: p * q,
                "/": lambda: p // q,
                "%": lambda: p % q,
                "<": lambda: p < q,
                ">": lambda: p > q,
                "<=": lambda: p <= q,
                ">=": lambda: p >= q,
                "==": lambda: p == q,
                "!=": lambda: p != q,
                "&&": lambda: p and q,
                "||": lambda: p or q,
            }[operation]()
        if operation in ("<", ">", "<=", ">=") and isinstance(p, Number) and isinstance(q, Number):
            self.compared.append((text_of(node), self.rounding.settled(p), self.rounding.settled(q)))
        if operation in ("<", ">", "<=", ">=", "==", "!=", "&&", "||", "&", "|", "%", "<<", ">>"):
            return UNKNOWN
        if isinstance(p, Unknown) or isinstance(q, Unknown):
            return UNKNOWN
        p, q = self._real(p), self._real(q)
        if operation == "*":
            return self._multiply(p, q)
        return self._pairwise(p, q, {"+": self._add, "-": self._subtract, "/": self.rounding.divide}[operation])

    def _add(self, p, q):
        return self.rounding.add(p, q, self.precise)

    def _subtract(self, p, q):
        return self.rounding.add(p, self.rounding.negated(q), self.precise)

    @staticmethod
    def _real(value):
        return exactly(value) if isinstance(value, int) else value

    def _each(self, value, operation):
        if isinstance(value, (Vector, Matrix)):
            return type(value)(self._each(part, operation) for part in value)
        return operation(value) if isinstance(value, Number) else value

    def _pairwise(self, p, q, operation):
        if isinstance(p, (Vector, Matrix)) and isinstance(q, (Vector, Matrix)):
            if len(p) != len(q):
                raise ValueError("lengths differ")
            return type(p)(self._pairwise(x, y, operation) for x, y in zip(p, q))
        if isinstance(p, (Vector, Matrix)):
            return type(p)(self._pairwise(x, q, operation) for x in p)
        if isinstance(q, (Vector, Matrix)):
            return type(q)(self._pairwise(p, y, operation) for y in q)
        return operation(self._real(p), self._real(q))

    def _dot(self, p, q):
        total = None
        for x, y in zip(p, q, strict=True):
            product = self.rounding.multiply(self._real(x), self._real(y))
            total = product if total is None else self._add(total, product)
        return total

    def _multiply(self, p, q):
        if isinstance(p, Matrix) and isinstance(q, Matrix):
            return Matrix(self._multiply(p, column) for column in q)
        if isinstance(p, Matrix) and isinstance(q, Vector):
            return Vector(self._dot([column[row] for column in p], q) for row in range(3))
        if isinstance(p, Vector) and isinstance(q, Matrix):
            return Vector(self._dot(p, column) for column in q)
        return self._pairwise(p, q, self.rounding.multiply)

    # ---- calls

    def _evaluate_call(self, node, scope):
        name = node.name
        arguments = [self.evaluate(part, scope) for part in node.parts]
        if name in scope and callable(scope[name]):
            return scope[name](*arguments)
        if name in self.contracts:
            self.used.add(("contract", name))
            return self.contracts[name](self, *arguments)
        if name in self.conversions:
            return self.conversions[name](self, *arguments)
        if name in self.sources.structs:
            return self._struct(node, name, arguments)
        plain = name.removeprefix("std::").removeprefix("radar::")
        built_in = getattr(self, f"_call_{plain}", None)
        if built_in is not None and not self.sources.functions.get(name):
            return built_in(*arguments)
        function = self.sources.function(
            plain,
            lambda f: len(f.parameters) == len(arguments)
            and all(self._fits(value, p[0]) for value, p in zip(arguments, f.parameters)),
        )
        result, inner = self.run(function, arguments)
        for part, parameter in zip(node.parts, function.parameters):
            if parameter[2]:
                self.assign(part, inner[parameter[1]], scope)
        return result

    def _evaluate_method(self, node, scope):
        """A call of an object's function: only contracts know any."""
        if node.name not in self.contracts:
            raise SourceError(f"{node.place}: no claim knows what '{node.name}' does")
        self.used.add(("contract", node.name))
        return self.contracts[node.name](self, *(self.evaluate(part, scope) for part in node.parts[1:]))

    def _struct(self, node, name, values):
        members = self.sources.structs[name]
        if len(values) != len(members):
            raise SourceError(f"{node.place}: {name} has {len(members)} members, not {len(values)}")
        return dict(zip(members, values), type=name)

    def _call_abs(self, x):
        return self._each(self._real(x), self.rounding.absolute)

    def _call_min(self, x, y):
        return min(x, y) if isinstance(x, int) and isinstance(y, int) else self._pairwise(x, y, self.rounding.minimum)

    def _call_max(self, x, y):
        return max(x, y) if isinstance(x, int) and isinstance(y, int) else self._pairwise(x, y, self.rounding.maximum)

    def _call_dot(self, p, q):
        return self._dot(p, q)

    def _call_cross(self, p, q):
        def minor(i, j):
            return self._subtract(self.rounding.multiply(p[i], q[j]), self.rounding.multiply(p[j], q[i]))

        return Vector([minor(1, 2), minor(2, 0), minor(0, 1)])

    def _call_transpose(self, m):
        return Matrix(Vector(column[row] for column in m) for row in range(3))

    def _call_mat3(self, *columns):
        return Matrix(columns)

    def _vector(self, n, values):
        flat = [x for value in values for x in (value if isinstance(value, Vector) else [self._real(value)])]
        return Vector(flat * n if len(flat) == 1 else flat)

    def _call_vec2(self, *values):
        return self._vector(2, values)

    def _call_vec3(self, *values):
        # GLSL's vec3[3](x, y, z) of vectors is an array.
        return (
            list(values)
            if values and all(isinstance(v, Vector) for v in values) and len(values) == 3
            else self._vector(3, values)
        )

    def _call_vec4(self, *values):
        return self._vector(4, values)

    _call_dvec3 = _call_vec3

    def _call_float(self, x):
        return self._real(x)

    _call_double = _call_float

    def _call_all(self, conditions):
        return UNKNOWN

    def _call_lessThanEqual(self, x, y):
        for p, q in zip(x, y, strict=True):
            self.compared.append(("lessThanEqual", self.rounding.settled(p), self.rounding.settled(q)))
        return UNKNOWN
