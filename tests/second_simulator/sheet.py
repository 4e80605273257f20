"""A sheet of named values that becomes XML for JSBSim: written as equations, read as functions and tables.

JSBSim computes everything from here on; this file only spells it. A value called `a_b` is the property `xv/a-b`.
"""

import ast
from xml.sax.saxutils import quoteattr

STEP_S = 1 / 250
SIGNS = {ast.Add: "sum", ast.Sub: "difference", ast.Mult: "product", ast.Div: "quotient", ast.Pow: "pow"}


class Sheet:
    """Values in the order in which JSBSim computes them."""

    def __init__(self, known):
        self.path = dict(known)
        self.states = {}
        self.lines = {"systems": [], "airframe": []}
        self.number = 0

    def _xml(self, node):
        if isinstance(node, ast.Constant):
            return f"<v>{node.value!r}</v>"
        if isinstance(node, ast.Name):
            return f"<p>{self.path[node.id]}</p>"
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            return f"<product><v>-1</v>{self._xml(node.operand)}</product>"
        if isinstance(node, ast.BinOp):
            sign = SIGNS[type(node.op)]
            return f"<{sign}>{self._xml(node.left)}{self._xml(node.right)}</{sign}>"
        if isinstance(node, ast.Call):
            inside = "".join(self._xml(each) for each in node.args)
            return f"<{node.func.id}>{inside}</{node.func.id}>"
        raise ValueError(f"no such expression: {ast.dump(node)}")

    def spell(self, text):
        """An equation as XML."""
        return self._xml(ast.parse(text.strip(), mode="eval").body)

    def _put(self, part, name, body):
        self.path[name] = path = "xv/" + name.replace("_", "-")
        if part == "systems":
            line = f"<fcs_function name={quoteattr(path)}><function>{body}</function></fcs_function>"
        else:
            line = f"<function name={quoteattr(path)}>{body}</function>"
        self.lines[part].append(line)

    def let(self, part, name, text):
        """name = text."""
        self._put(part, name, self.spell(text))

    def table(self, part, name, arguments, axes, values):
        """name = a table of one, two or three arguments, linear between its points, held at its ends."""
        rows = ["row", "column", "table"]
        if len(arguments) == 3:  # JSBSim wants the slowest of three last
            arguments, axes = arguments[1:] + arguments[:1], axes[1:] + axes[:1]
            turned = axes[2]
        head = "".join(
            f'<independentVar lookup="{rows[i]}">{self.path[each]}</independentVar>'
            for i, each in enumerate(arguments)
        )

        def block(block_values):
            if len(arguments) == 1:
                return "\n".join(f"{x:g} {y:g}" for x, y in zip(axes[0], block_values))
            top = " ".join(f"{x:g}" for x in axes[1])
            return (
                top
                + "\n"
                + "\n".join(
                    f"{x:g} " + " ".join(f"{y:g}" for y in row) for x, row in zip(axes[0], block_values)
                )
            )

        if len(arguments) == 3:
            data = "".join(
                f'<tableData breakPoint="{at:g}">\n{block(each)}\n</tableData>'
                for at, each in zip(turned, values)
            )
        else:
            data = f"<tableData>\n{block(values)}\n</tableData>"
        self._put(part, name, f"<table>{head}{data}</table>")

    def state(self, name, start):
        """A value that is remembered from tick to tick, and can be set from outside."""
        self.path[name] = "st/" + name.replace("_", "-")
        self.states[name] = start

    def next(self, name, text):
        """The state's value after this tick. Nothing moves while `running` is 0."""
        self.number += 1
        body = self.spell(f"{name} + running * (({text}) - {name})")
        self.lines["systems"].append(
            f'<fcs_function name="step/n{self.number}"><function>{body}</function>'
            f"<output>{self.path[name]}</output></fcs_function>"
        )

    def follow(self, name, towards, lag_s, rate, low, high):
        """A first-order lag with a limit of its rate, per second, and of its value."""
        step = f"min({rate * STEP_S!r}, max({-rate * STEP_S!r}, {STEP_S / lag_s!r} * (({towards}) - {name})))"
        self.next(name, f"min({high!r}, max({low!r}, {name} + {step}))")

    def send(self, source, target):
        """Writes a value into a property of JSBSim's own."""
        self.number += 1
        self.lines["systems"].append(
            f'<fcs_function name="step/n{self.number}"><function>{self.spell(source)}</function>'
            f"<output>{target}</output></fcs_function>"
        )
