"""Reads functions, constants and structs from GLSL and C++ sources, in the subset in which the tests with margins are
written.

Only what a claim uses is parsed; anything outside the subset stops the reader with the file and line.
"""
import re
import struct
from dataclasses import dataclass, field
from fractions import Fraction

_TOKEN = re.compile(
    r"""
    (?P<space>[ \t\r]+|//[^\n]*|\\\n)
  | (?P<comment>/\*.*?\*/)
  | (?P<newline>\n)
  | (?P<directive>\#(?:[^\n\\]|\\\n|\\.)*)
  | (?P<number>0x[0-9a-fA-F.]+p[+-]?\d+(?:LF|f)?|0x[0-9a-fA-F]+u?|(?:\d+\.\d*|\.\d+|\d+)(?:[eE][+-]?\d+)?(?:LF|lf|f|u)?)
  | (?P<name>[A-Za-z_]\w*(?:::[A-Za-z_]\w*)*)
  | (?P<string>"[^"\n]*")
  | (?P<mark>\+\+|--|\+=|-=|\*=|/=|&=|<=|>=|==|!=|&&|\|\||<<|>>|\[\[|\]\]|->|::|[-+*/%<>=!&|^~?:;,.(){}\[\]])
""",
    re.VERBOSE | re.DOTALL,
)

_QUALIFIERS = {"const", "precise", "in", "inout", "out", "inline", "constexpr", "static"}


class SourceError(Exception):
    """A place in a source that the reader does not understand, or that a claim names and the source lacks."""


@dataclass(eq=False)
class Token:
    kind: str
    text: str
    file: str
    line: int

    @property
    def place(self):
        return f"{self.file}:{self.line}"


@dataclass
class Node:
    """A piece of syntax: `kind` says which of the other members count."""

    kind: str
    token: Token
    name: str = ""
    parts: list = field(default_factory=list)
    value: object = None

    @property
    def place(self):
        return self.token.place


@dataclass
class Function:
    name: str
    parameters: list  # (type, name, whether the caller sees changes)
    tokens: list  # of the body, braces included
    initialisers: list  # tokens of a constructor's members
    body: Node = None

    @property
    def place(self):
        return self.tokens[0].place


def tokens_of(text, file):
    tokens, line, at = [], 1, 0
    while at < len(text):
        match = _TOKEN.match(text, at)
        if not match:
            raise SourceError(f"{file}:{line}: no token begins with {text[at]!r}")
        kind, word = match.lastgroup, match.group()
        if kind not in ("space", "comment", "newline", "directive"):
            tokens.append(Token(kind, word, file, line))
        line += word.count("\n")
        at = match.end()
    return tokens


def number_of(token):
    """The exact value of a literal: of a float's, what a compiler rounds it to."""
    text = token.text
    if text.startswith("0x") and "p" not in text:
        return int(text.rstrip("u"), 16)
    if re.fullmatch(r"\d+u?", text):
        return int(text.rstrip("u"))
    is_float = (text.endswith("f") and not text.endswith("lf")) or (
        token.file.endswith(".glsl") and not text.lower().endswith("lf")
    )
    digits = text.lower().removesuffix("lf") if not text.startswith("0x") else text.removesuffix("f")
    digits = digits.removesuffix("f") if not text.startswith("0x") else digits
    value = float.fromhex(digits) if digits.startswith("0x") else float(digits)
    if is_float:
        value = struct.unpack("f", struct.pack("f", value))[0]
    return Fraction(value)


class Parser:
    """A recursive-descent parser over a list of tokens."""

    def __init__(self, tokens, types):
        self.tokens, self.types, self.at = tokens, types, 0

    def peek(self, ahead=0):
        at = self.at + ahead
        return (
            self.tokens[at] if at < len(self.tokens) else Token("end", "", self.tokens[-1].file, self.tokens[-1].line)
        )

    def next(self):
        token = self.peek()
        self.at += 1
        return token

    def accept(self, text):
        if self.peek().text == text and self.peek().kind != "string":
            return self.next()
        return None

    def expect(self, text):
        token = self.next()
        if token.text != text:
            raise SourceError(f"{token.place}: expected '{text}', found '{token.text}'")
        return token

    def name(self):
        token = self.next()
        if token.kind != "name":
            raise SourceError(f"{token.place}: expected a name, found '{token.text}'")
        return token

    # ---- types

    def skip_template_arguments(self):
        """Steps over <...> if it holds only type names; returns whether it did."""
        if self.peek().text != "<":
            return False
        ahead = 1
        while self.peek(ahead).kind == "name" or self.peek(ahead).text == ",":
            ahead += 1
        if self.peek(ahead).text != ">":
            return False
        self.at += ahead + 1
        return True

    def type_ahead(self):
        """The type that a declaration begins with here, or None; steps over it."""
        start = self.at
        qualifiers = set()
        while self.peek().text in _QUALIFIERS:
            qualifiers.add(self.next().text)
        if self.peek().kind == "name" and (self.peek().text in self.types or self.peek().text == "auto"):
            base = self.next().text
            self.skip_template_arguments()
            self.accept("&") or self.accept("*")
            if self.peek().text == "[" and self.peek(1).kind == "number":  # GLSL's T[n] name
                self.at += 3
            if self.peek().kind == "name":
                return base, qualifiers
        self.at = start
        return None

    # ---- statements

    def statement(self):
        token = self.peek()
        if token.text == "{":
            self.next()
            parts = []
            while not self.accept("}"):
                parts.append(self.statement())
            return Node("block", token, parts=parts)
        if token.text == "if":
            self.next()
            if self.accept("constexpr"):
                pass
            self.expect("(")
            condition = self.expression()
            self.expect(")")
            then = self.statement()
            parts = [condition, then] + ([self.statement()] if self.accept("else") else [])
            return Node("if", token, parts=parts)
        if token.text == "for":
            return self.loop()
        if token.text == "return":
            self.next()
            value = None if self.peek().text == ";" else self.initialiser()
            self.expect(";")
            return Node("return", token, parts=[value] if value else [])
        if token.text in ("break", "continue"):
            self.next()
            self.expect(";")
            return Node(token.text, token)
        if token.text == "using":
            self.next()
            self.types.add(self.name().text)
            while self.next().text != ";":
                pass
            return Node("block", token)
        declared = self.type_ahead()
        if declared:
            return self.declaration(token, *declared)
        node = self.assignment()
        self.expect(";")
        return node

    def declaration(self, token, base, qualifiers):
        declarations = []
        while True:
            name = self.name()
            dimensions = []
            while self.accept("["):
                dimensions.append(self.expression())
                self.expect("]")
            value = None
            if self.accept("="):
                value = self.initialiser()
            elif self.peek().text == "{":
                value = self.initialiser()
            elif self.accept("("):
                value = Node("call", name, name=base, parts=self.arguments(")"))
            declarations.append(
                Node(
                    "declare",
                    name,
                    name=name.text,
                    parts=[value] if value else [],
                    value=(base, dimensions, qualifiers),
                )
            )
            if not self.accept(","):
                break
        self.expect(";")
        return Node("block", token, name="declarations", parts=declarations)

    def loop(self):
        token = self.next()
        self.expect("(")
        if not self.type_ahead():
            raise SourceError(f"{token.place}: a loop must declare its counter")
        counter = self.name().text
        self.expect("=")
        first = self.expression()
        self.expect(";")
        condition = self.expression()
        self.expect(";")
        if not (self.accept("++") and self.name().text == counter):
            raise SourceError(f"{token.place}: a loop must count upwards by 1")
        self.expect(")")
        return Node("for", token, name=counter, parts=[first, condition, self.statement()])

    def assignment(self):
        target = self.expression()
        token = self.peek()
        if token.text in ("=", "+=", "-=", "*=", "/=", "&="):
            self.next()
            return Node("assign", token, name=token.text, parts=[target, self.initialiser()])
        return Node("evaluate", token, parts=[target])

    # ---- expressions

    def initialiser(self):
        token = self.peek()
        if self.accept("{"):
            return Node("list", token, parts=self.arguments("}"))
        return self.expression()

    def arguments(self, end):
        parts = []
        while not self.accept(end):
            parts.append(self.initialiser())
            if not self.accept(","):
                self.expect(end)
                break
        return parts

    def expression(self):
        condition = self.binary(0)
        token = self.peek()
        if not self.accept("?"):
            return condition
        yes = self.expression()
        self.expect(":")
        return Node("choose", token, parts=[condition, yes, self.expression()])

    _LEVELS = [
        ["||"],
        ["&&"],
        ["|"],
        ["^"],
        ["&"],
        ["==", "!="],
        ["<", ">", "<=", ">="],
        ["<<", ">>"],
        ["+", "-"],
        ["*", "/", "%"],
    ]

    def binary(self, level):
        if level == len(self._LEVELS):
            return self.unary()
        left = self.binary(level + 1)
        while self.peek().kind == "mark" and self.peek().text in self._LEVELS[level]:
            token = self.next()
            left = Node("binary", token, name=token.text, parts=[left, self.binary(level + 1)])
        return left

    def unary(self):
        token = self.peek()
        if token.text in ("-", "+", "!", "*", "&", "~"):
            self.next()
            return Node("unary", token, name=token.text, parts=[self.unary()])
        return self.postfix()

    def postfix(self):
        node = self.primary()
        while True:
            token = self.peek()
            if self.accept("."):
                node = Node("member", token, name=self.name().text, parts=[node])
            elif self.accept("["):
                node = Node("index", token, parts=[node, self.expression()])
                self.expect("]")
            elif node.kind == "member" and self.accept("("):
                node = Node("method", token, name=node.name, parts=node.parts + self.arguments(")"))
            else:
                return node

    def closure(self, token):
        """C++'s [&](type name, ...) { ... }."""
        self.accept("&")
        self.expect("]")
        self.expect("(")
        parameters = []
        while not self.accept(")"):
            if not self.type_ahead():
                raise SourceError(f"{self.peek().place}: expected a parameter")
            parameters.append(self.name().text)
            self.accept(",")
        return Node("closure", token, value=parameters, parts=[self.statement()])

    def primary(self):
        token = self.next()
        if token.text == "(":
            node = self.expression()
            self.expect(")")
            return node
        if token.kind == "number":
            return Node("number", token, value=number_of(token))
        if token.text == "[":
            return self.closure(token)
        if token.text == "static_cast":
            self.skip_template_arguments()
            self.expect("(")
            return Node("call", token, name="static_cast", parts=self.arguments(")"))
        if token.kind != "name":
            raise SourceError(f"{token.place}: '{token.text}' is not understood here")
        self.skip_template_arguments()
        if self.peek().text == "[" and token.text in self.types:  # GLSL's T[n](...)
            self.at += 3
        if self.accept("("):
            return Node("call", token, name=token.text, parts=self.arguments(")"))
        if self.peek().text == "{" and token.text in self.types:
            self.next()
            return Node("call", token, name=token.text, parts=self.arguments("}"))
        return Node("name", token, name=token.text)


def text_of(node):
    """The source of an expression, in one spelling."""
    k, p = node.kind, node.parts
    if k == "number":
        return node.token.text
    if k == "name":
        return node.name
    if k == "member":
        return f"{text_of(p[0])}.{node.name}"
    if k == "index":
        return f"{text_of(p[0])}[{text_of(p[1])}]"
    if k == "unary":
        return f"{node.name}{text_of(p[0])}"
    if k == "binary":
        return f"{text_of(p[0])} {node.name} {text_of(p[1])}"
    if k == "call":
        return f"{node.name}({', '.join(map(text_of, p))})"
    if k == "method":
        return f"{text_of(p[0])}.{node.name}({', '.join(map(text_of, p[1:]))})"
    if k == "choose":
        return f"{text_of(p[0])} ? {text_of(p[1])} : {text_of(p[2])}"
    return "{" + ", ".join(map(text_of, p)) + "}"


_BUILT_IN_TYPES = set(
    "void bool int uint unsigned size_t float double vec2 vec3 vec4 dvec3 ivec3 uvec2 uvec3 uvec4 mat2 mat3 "
    "Real Vector Lanes LaneVec".split()
)


class Sources:
    """The functions, structs and constants of some files."""

    def __init__(self, root, files):
        self.root = root
        self.functions, self.structs, self.constants, self.types = {}, {}, {}, set(_BUILT_IN_TYPES)
        for file in files:
            path = root / file
            if not path.is_file():
                raise SourceError(f"{file} does not exist")
            self._scan(tokens_of(path.read_text(), file))

    def _scan(self, tokens):
        """Finds definitions at any depth of namespaces; bodies are not parsed yet."""
        at = 0
        while at < len(tokens):
            token = tokens[at]
            text = token.text
            following = tokens[at + 1] if at + 1 < len(tokens) else None
            if text in ("struct", "class") and following and following.kind == "name" and tokens[at + 2].text == "{":
                at = self._scan_struct(tokens, at)
            elif text == "operator" and [t.text for t in tokens[at + 1 : at + 4]] == ["(", ")", "("]:
                at = self._scan_function(tokens, at, "operator()", at + 3)
            elif text == "operator" and following.kind == "mark" and tokens[at + 2].text == "(":
                at = self._scan_function(tokens, at, text + following.text, at + 2)
            elif self._may_be_function(tokens, at):
                at = self._scan_function(tokens, at, text, at + 1)
            elif text in ("const", "constexpr") and following.kind == "name":
                at = self._scan_constant(tokens, at)
            else:
                at += 1

    @staticmethod
    def _may_be_function(tokens, at):
        """Whether parameters follow a name, and before it stands a type, a scope or, for a constructor, an end."""
        if tokens[at].kind != "name" or at + 1 >= len(tokens) or tokens[at + 1].text != "(":
            return False
        before = tokens[at - 1]
        return before.text in (">", "&", "]", "::", ";", "}", "{") or (
            before.kind == "name" and before.text != "return"
        )

    @staticmethod
    def _closing(tokens, at):
        """The place after the bracket that closes the one at `at`."""
        pairs = {"(": ")", "{": "}", "[": "]"}
        opening, closing, depth = tokens[at].text, pairs[tokens[at].text], 0
        while True:
            depth += (tokens[at].text == opening) - (tokens[at].text == closing)
            at += 1
            if depth == 0:
                return at

    def _scan_struct(self, tokens, at):
        name, end = tokens[at + 1].text, self._closing(tokens, at + 2)
        self.types.add(name)
        members, i = [], at + 3
        while i < end - 1:
            stop = i
            while stop < end - 1 and tokens[stop].text not in (";", "{", "("):
                stop += 1
            if stop < end - 1 and tokens[stop].text != ";":  # a function: scanned by its own rule
                break
            words = [t for t in tokens[i:stop] if t.kind == "name" or t.text == ","]
            for j, word in enumerate(words):
                if j > 0 and word.text != "," and (j + 1 == len(words) or words[j + 1].text == ","):
                    members.append(word.text)
            i = stop + 1
        self.structs[name] = members
        return at + 3 if any(t.text == "(" for t in tokens[at:end]) else end

    def _scan_function(self, tokens, at, name, opening):
        """Steps over a definition with its parameters from `opening` on, or over the name if it is none."""
        closed = self._closing(tokens, opening)
        body = closed
        while body < len(tokens) and tokens[body].text in ("const", "noexcept", "override"):
            body += 1
        initialisers = body
        if body < len(tokens) and tokens[body].text == ":":
            while body < len(tokens) and tokens[body].text not in ("{", ";"):
                body = self._closing(tokens, body) if tokens[body].text == "(" else body + 1
        if body >= len(tokens) or tokens[body].text != "{":
            return at + 1
        end = self._closing(tokens, body)
        types = self.types | {t.text for t in tokens[opening + 1 : closed] if t.kind == "name"}
        parser = Parser(tokens[opening + 1 : closed], types)
        parameters = []
        while parser.peek().text not in (")", ""):
            declared = parser.type_ahead()
            if not declared:
                break
            base, qualifiers = declared
            parameter = parser.name().text
            while parser.accept("["):
                parser.next()
                parser.expect("]")
                base += "[]"
            parameters.append((base, parameter, bool(qualifiers & {"inout", "out"})))
            if not parser.accept(","):
                break
        function = Function(name, parameters, tokens[body:end], tokens[initialisers:body])
        self.functions.setdefault(name, []).append(function)
        return end

    def _scan_constant(self, tokens, at):
        """`const T a = x, b = y;` at file level; steps over it."""
        end = at
        while end < len(tokens) and tokens[end].text not in (";", "{", "("):
            end += 1
        parser = Parser(tokens[at + 1 : end], self.types)
        if end >= len(tokens) or tokens[end].text not in (";", "("):
            return at + 1
        while end < len(tokens) and tokens[end].text != ";":
            end = self._closing(tokens, end) if tokens[end].text in ("(", "{", "[") else end + 1
        if end == len(tokens):
            return at + 1
        parser = Parser(tokens[at + 1 : end] + [tokens[end]], self.types)
        parser.next()
        parser.skip_template_arguments()
        while parser.peek().kind == "name" and parser.peek(1).text == "=":
            name = parser.next().text
            parser.next()
            start = parser.at
            depth = 0
            while parser.peek().text != ";" and not (depth == 0 and parser.peek().text == ","):
                depth += (parser.peek().text in ("(", "{")) - (parser.peek().text in (")", "}"))
                parser.next()
            self.constants.setdefault(name, []).append(parser.tokens[start : parser.at])
            if not parser.accept(","):
                break
        return end + 1

    def function(self, name, matches=lambda function: True):
        found = [f for f in self.functions.get(name, []) if matches(f)]
        if len(found) != 1:
            places = ", ".join(f.place for f in self.functions.get(name, [])) or "no function of that name"
            raise SourceError(f"the function {name} is needed once, found {len(found)} times that fit: {places}")
        return found[0]

    def initialisers(self, function):
        """The members that a constructor initialises, with their expressions."""
        if not function.initialisers:
            return []
        parser = Parser(function.initialisers + [Token("mark", ";", "", 0)], self.types)
        parser.expect(":")
        found = []
        while not parser.accept(";"):
            member = parser.name()
            parser.expect("(")
            found.append((member.text, Node("list", member, parts=parser.arguments(")"))))
            parser.accept(",")
        return found

    def body(self, function):
        if function.body is None:
            function.body = Parser(function.tokens, self.types).statement()
        return function.body

    def constant(self, name):
        if len(self.constants[name]) != 1:
            raise SourceError(f"{self.constants[name][1][0].place}: {name} has another definition")
        return Parser(self.constants[name][0] + [Token("mark", ";", "", 0)], self.types).initialiser()

    def expression(self, owner, text):
        """The expression `text`, which the function `owner` contains exactly once."""
        return Parser(self._occurrence(owner, text) + [Token("mark", ";", "", 0)], self.types).expression()

    def value(self, name):
        """The value of a constant that is a number."""
        node = self.constant(name)
        if node.kind != "number":
            raise SourceError(f"{node.place}: {name} is expected to be a number")
        return node.value

    def _occurrence(self, owner, text):
        """The tokens of `text` in the function or constant `owner`, which contains it exactly once."""
        wanted = [t.text for t in tokens_of(text, owner)]
        bodies = [f.initialisers + f.tokens for f in self.functions.get(owner, [])] + self.constants.get(owner, [])
        found = [
            body[i : i + len(wanted)]
            for body in bodies
            for i in range(len(body))
            if [t.text for t in body[i : i + len(wanted)]] == wanted
        ]
        if len(found) != 1:
            raise SourceError(f"'{text}' is expected once in {owner}, found {len(found)} times")
        return found[0]

    def literal(self, owner, text):
        """The token of the first number in `text`, which the function or constant `owner` contains exactly once."""
        return next(t for t in self._occurrence(owner, text) if t.kind == "number")
