"""Reads functions, constants and structs from GLSL and C++ sources, in the subset in which the tests with margins are
written.

Only what a claim uses is parsed; anything outside the subset stops the reader with the file and line.
"""
import copy
import re
import struct
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

_TOKEN = re.compile(
    r"""
    (?P<space>\s+|//[^\n]*|\\\n|/\*.*?\*/|\#(?:[^\n\\]|\\\n|\\.)*)
  | (?P<number>0x[0-9a-fA-F.]+p[+-]?\d+(?:LF|f)?|0x[0-9a-fA-F]+u?|(?:\d+\.\d*|\.\d+|\d+)(?:[eE][+-]?\d+)?(?:LF|lf|f|u)?)
  | (?P<name>[A-Za-z_]\w*(?:::[A-Za-z_]\w*)*)
  | (?P<string>"[^"\n]*")
  | (?P<mark>\+\+|--|\+=|-=|\*=|/=|&=|<=|>=|==|!=|&&|\|\||<<|>>|->|::|[-+*/%<>=!&|^~?:;,.(){}\[\]])
""",
    re.VERBOSE | re.DOTALL,
)
_QUALIFIERS = ("const", "precise", "in", "inout", "out", "inline", "constexpr", "static")
_ASSIGNMENTS = ("=", "+=", "-=", "*=", "/=", "&=")
_LEVELS = ("||", "&&", "|", "^", "&", "== !=", "< > <= >=", "<< >>", "+ -", "* / %")
_PRECEDENCE = {operator: level for level, operators in enumerate(_LEVELS) for operator in operators.split()}


class SourceError(Exception):
    """A place in a source that the reader does not understand, or that a claim names and the source lacks."""


@dataclass(eq=False)
class Token:
    kind: str
    text: str
    file: str
    place: str


@dataclass
class Node:
    """A piece of syntax: `kind` says which of the other members count. `text`: its source without spaces."""

    kind: str
    token: Token
    text: str
    parts: list
    name: str = ""
    value: object = None


@dataclass
class Function:
    name: str
    parameters: list  # (type, name, whether the caller sees changes)
    tokens: list  # of the body, braces included
    initialisers: list  # tokens of a constructor's members

    @cached_property
    def body(self):
        return Parser(self.tokens).statement()

    def initialised(self):
        """The members that a constructor initialises, with their expressions."""
        parser, found = Parser(self.initialisers), {}
        while parser.accept(":", ","):
            member = parser.name().text
            parser.expect("(")
            found[member] = parser.bracketed(")")
        return found


def tokens_of(text, file):
    tokens, line, at = [], 1, 0
    while at < len(text):
        match = _TOKEN.match(text, at)
        if not match:
            raise SourceError(f"{file}:{line}: no token begins with {text[at]!r}")
        if match.lastgroup != "space":
            tokens.append(Token(match.lastgroup, match.group(), file, f"{file}:{line}"))
        line += match.group().count("\n")
        at = match.end()
    return tokens


def number_of(token):
    """The exact value of a literal: of a float's, what a compiler rounds it to."""
    text = token.text.lower()
    if re.fullmatch(r"(0x[0-9a-f]+|\d+)u?", text):
        return int(text.rstrip("u"), 0)
    digits, suffix = re.fullmatch(r"(.*?)(lf|f)?", text).groups()
    value = float.fromhex(digits) if digits.startswith("0x") else float(digits)
    if suffix == "f" or (suffix is None and token.file.endswith(".glsl")):
        value = struct.unpack("f", struct.pack("f", value))[0]
    return Fraction(value)


class Parser:
    """A recursive-descent parser over a list of tokens."""

    def __init__(self, tokens):
        self.tokens, self.at = tokens, 0
        self.end = Token("end", "", "", tokens[-1].place if tokens else "")

    def peek(self, ahead=0):
        at = self.at + ahead
        return self.tokens[at] if at < len(self.tokens) else self.end

    def next(self):
        token = self.peek()
        self.at += 1
        return token

    def accept(self, *texts):
        return self.next() if self.peek().text in texts else None

    def expect(self, *texts):
        for text in texts:
            token = self.next()
            if token.text != text:
                raise SourceError(f"{token.place}: expected '{text}', found '{token.text}'")

    def name(self):
        token = self.next()
        if token.kind != "name":
            raise SourceError(f"{token.place}: expected a name, found '{token.text}'")
        return token

    def node(self, kind, start, parts=(), name="", value=None):
        """What has been read since the place `start`."""
        text = "".join(token.text for token in self.tokens[start : self.at])
        return Node(kind, self.tokens[start], text, list(parts), name, value)

    # Types

    def skip_template_arguments(self):
        """Steps over <...> if it holds only names and numbers."""
        ahead = 1
        while self.peek(ahead).kind in ("name", "number") or self.peek(ahead).text == ",":
            ahead += 1
        if self.peek().text == "<" and self.peek(ahead).text == ">":
            self.at += ahead + 1

    def type_ahead(self):
        """The type and the qualifiers that a declaration begins with here, or None; steps over them. A name follows."""
        start, qualifiers = self.at, set()
        while self.peek().text in _QUALIFIERS:
            qualifiers.add(self.next().text)
        if self.peek().kind == "name":
            base = self.next().text
            self.skip_template_arguments()
            self.accept("&", "*")
            if self.peek().kind == "name":
                return base, qualifiers
        self.at = start
        return None

    def parameters(self):
        """Those up to a closing bracket or the first that is not understood."""
        found = []
        while declared := self.type_ahead():
            base, qualifiers = declared
            name = self.name().text
            while self.accept("["):
                self.next()
                self.expect("]")
                base += "[]"
            found.append((base, name, bool(qualifiers & {"inout", "out"})))
            self.accept(",")
        return found

    # Statements

    def statement(self):
        start, token = self.at, self.peek()
        if self.accept("{"):
            parts = []
            while not self.accept("}"):
                parts.append(self.statement())
            return self.node("block", start, parts)
        if self.accept("if"):
            self.expect("(")
            parts = [self.bracketed(")"), self.statement()]
            if self.accept("else"):
                parts.append(self.statement())
            return self.node("if", start, parts)
        if self.accept("for"):
            return self.loop(start)
        if self.accept("using"):
            while self.next().text not in (";", ""):
                pass
            return self.node("block", start)
        if self.accept("return", "break", "continue"):
            parts = [] if self.peek().text == ";" else [self.initialiser()]
            node = self.node(token.text, start, parts)
        elif declared := self.type_ahead():
            node = self.declarations(start, *declared)
        else:
            node = self.assignment(start)
        self.expect(";")
        return node

    def declarations(self, start, base, qualifiers):
        parts = []
        while not parts or self.accept(","):
            here, name, value = self.at, self.name().text, []
            while self.accept("["):
                self.bracketed("]")
            if self.accept("=") or self.peek().text == "{":
                value = [self.initialiser()]
            elif self.accept("("):
                arguments = self.arguments(")")
                value = [self.node("call", here, arguments, name=base)]
            parts.append(self.node("declare", here, value, name, (base, qualifiers)))
        return self.node("block", start, parts)

    def loop(self, start):
        """for (int name = first; condition; ++name) statement"""
        self.expect("(")
        if not self.type_ahead():
            raise SourceError(f"{self.peek().place}: a loop must declare its counter")
        counter = self.name().text
        self.expect("=")
        parts = [self.bracketed(";"), self.bracketed(";")]
        self.expect("++", counter, ")")
        return self.node("for", start, parts + [self.statement()], counter)

    def assignment(self, start):
        target = self.expression()
        if operator := self.accept(*_ASSIGNMENTS):
            return self.node("assign", start, [target, self.initialiser()], operator.text)
        return self.node("evaluate", start, [target])

    # Expressions

    def initialiser(self):
        start = self.at
        if self.accept("{"):
            return self.node("list", start, self.arguments("}"))
        return self.expression()

    def arguments(self, end):
        parts = []
        while not self.accept(end):
            parts.append(self.initialiser())
            if self.peek().text != end:
                self.expect(",")
        return parts

    def expression(self):
        start, node = self.at, self.binary(0)
        if self.accept("?"):
            node = self.node("choose", start, [node, self.bracketed(":"), self.expression()])
        return node

    def bracketed(self, end):
        """An expression and what follows it."""
        node = self.expression()
        self.expect(end)
        return node

    def binary(self, level):
        start, node = self.at, self.unary()
        while _PRECEDENCE.get(self.peek().text, -1) >= level:
            operator = self.next().text
            node = self.node("binary", start, [node, self.binary(_PRECEDENCE[operator] + 1)], operator)
        return node

    def unary(self):
        start = self.at
        if operator := self.accept("-", "+", "!", "*", "&", "~"):
            return self.node("unary", start, [self.unary()], operator.text)
        return self.postfix(start)

    def postfix(self, start):
        node = self.primary(start)
        while True:
            if self.accept(".", "->"):
                node = self.node("member", start, [node], self.name().text)
            elif self.accept("["):
                node = self.node("index", start, [node, self.bracketed("]")])
            elif node.kind == "member" and self.accept("("):
                node = self.node("method", start, node.parts + self.arguments(")"), node.name)
            else:
                return node

    def closure(self, start):
        """C++'s [&](type name, ...) { ... }."""
        self.accept("&")
        self.expect("]", "(")
        names = [name for _, name, _ in self.parameters()]
        self.expect(")")
        return self.node("closure", start, [self.statement()], value=names)

    def primary(self, start):
        token = self.next()
        if token.text == "(":
            return self.bracketed(")")
        if token.kind == "number":
            return self.node("number", start, value=number_of(token))
        if token.text == "[":
            return self.closure(start)
        if token.kind != "name":
            raise SourceError(f"{token.place}: '{token.text}' is not understood here")
        self.skip_template_arguments()
        if self.peek().text == "[" and self.peek(2).text == "]" and self.peek(3).text == "(":  # GLSL's T[n](...)
            self.at += 4
            return self.node("list", start, self.arguments(")"))
        if opening := self.accept("(", "{"):
            return self.node("call", start, self.arguments(")" if opening.text == "(" else "}"), token.text)
        return self.node("name", start, name=token.text)


def _after_bracket(tokens, at):
    """The place after the bracket that closes the one at `at`."""
    depth = 0
    while True:
        depth += (tokens[at].text in ("(", "[", "{")) - (tokens[at].text in (")", "]", "}"))
        at += 1
        if depth == 0:
            return at


def _up_to(tokens, at, ends):
    """The first place from `at` on, outside of brackets that open there, that is one of `ends`."""
    while tokens[at].text not in ends:
        at = _after_bracket(tokens, at) if tokens[at].text in ("(", "[", "{") else at + 1
    return at


def _only(what, found):
    if len(found) != 1:
        raise SourceError(f"{what} is needed once, and was found {len(found)} times")
    return found[0]


class Sources:
    """The functions, structs and constants of some files. `replaced`: by token, other values of literals."""

    replaced = {}

    def __init__(self):
        self.functions, self.structs, self.constants = {}, {}, {}

    @staticmethod
    @lru_cache(maxsize=None)
    def of(*files):
        sources = Sources()
        for file in files:
            if not (ROOT / file).is_file():
                raise SourceError(f"{file} does not exist")
            sources.add((ROOT / file).read_text(), file)
        return sources

    def replacing(self, replaced):
        other = copy.copy(self)
        other.replaced = replaced
        return other

    def elsewhere(self, *files):
        """Those of other files, with the same literals replaced."""
        return Sources.of(*files).replacing(self.replaced)

    def add(self, text, file):
        """Finds definitions at any depth of namespaces; bodies are not parsed yet."""
        tokens = tokens_of(text, file)
        tokens += [Token("mark", ";", file, file)] * 3
        at = 0
        while at < len(tokens) - 3:
            text, following = tokens[at].text, tokens[at + 1]
            if text in ("struct", "class") and following.kind == "name" and tokens[at + 2].text == "{":
                self._add_struct(following.text, tokens, at + 3)
                at += 3
            elif text == "operator":
                opening = _up_to(tokens, at + 2, ("(", ";"))
                at = self._add_function("".join(t.text for t in tokens[at:opening]), tokens, opening)
            elif tokens[at].kind == "name" and following.text == "(":
                at = self._add_function(text, tokens, at + 1)
            elif text in ("const", "constexpr"):
                at = self._add_constants(tokens, at + 1)
            else:
                at += 1

    def _add_struct(self, name, tokens, at):
        """The names of its members, in their order, up to the first function."""
        members = self.structs[name] = []
        while tokens[end := _up_to(tokens, at, (";", "{", "(", "}"))].text == ";":
            for before, token, after in zip(tokens[at:end], tokens[at + 1 : end], tokens[at + 2 : end + 1]):
                if token.kind == "name" and before.text != "=" and after.text in (",", ";", "=", "["):
                    members.append(token.text)
            at = end + 1

    def _add_function(self, name, tokens, opening):
        """A definition with its parameters from `opening` on, if it is one; steps over it, or its parameters."""
        closed = initialisers = _after_bracket(tokens, opening)
        while tokens[initialisers].text in ("const", "noexcept", "override"):
            initialisers += 1
        body = initialisers
        if tokens[body].text == ":":
            body = _up_to(tokens, body, ("{", ";"))
        if tokens[body].text != "{":
            return closed
        end = _after_bracket(tokens, body)
        parameters = Parser(tokens[opening + 1 : closed]).parameters()
        function = Function(name, parameters, tokens[body:end], tokens[initialisers:body])
        self.functions.setdefault(name, []).append(function)
        return end

    def _add_constants(self, tokens, at):
        """`T a = x, b = y;` after `const`, if it is that; steps over it."""
        while tokens[equals := _up_to(tokens, at, ("=", ",", ";", "(", "{", ")"))].text == "=":
            at = _up_to(tokens, equals + 1, (",", ";"))
            self.constants.setdefault(tokens[equals - 1].text, []).append(tokens[equals + 1 : at])
            at += 1
        return at

    def function(self, name, matches=lambda function: True):
        return _only(f"the function {name}", [f for f in self.functions.get(name, []) if matches(f)])

    def constant(self, name):
        """The expression of a constant."""
        return Parser(_only(f"the constant {name}", self.constants.get(name, []))).initialiser()

    def value(self, name):
        """The value of a constant that is a number."""
        return self.constant(name).value

    def expression(self, owner, text):
        """The expression `text`, which the function `owner` contains exactly once."""
        return Parser(self._occurrence(owner, text)).expression()

    def literal(self, owner, text):
        """The token of the first number in `text`, which the function or constant `owner` contains exactly once."""
        return next(t for t in self._occurrence(owner, text) if t.kind == "number")

    def number(self, owner, text):
        """The value of that literal."""
        token = self.literal(owner, text)
        return Fraction(self.replaced.get(token, number_of(token)))

    def _occurrence(self, owner, text):
        """The tokens of `text` in the function or constant `owner`, which contains it exactly once."""
        wanted = [t.text for t in tokens_of(text, owner)]
        bodies = [f.initialisers + f.tokens for f in self.functions.get(owner, [])] + self.constants.get(owner, [])
        pieces = (body[i : i + len(wanted)] for body in bodies for i in range(len(body)))
        return _only(f"'{text}' in {owner}", [piece for piece in pieces if [t.text for t in piece] == wanted])
