"""Effects whose equations are Python functions.

A function is called once, with symbols in the place of numbers. What it does with them is recorded as the expressions of an effect file, so the
effect is traced, saved and streamed without Python.
"""

import inspect

import numpy as np

from ._acm import effects_text
from ._plain import plain

#: Name of what an effect acts on, by place.
COLUMNS = {"actuators": ("q",), "outputs": ("y",), "frame": ("x", "y", "z")}

#: Names that every expression knows beside its own.
KNOWN = ("t", "dt", "pi")

# How operators bind, as in the expressions of an effect file.
OR, AND, COMPARISON, SUM, PRODUCT, SIGN, POWER, VALUE = range(1, 9)

UNARY = {
    np.absolute: "abs",
    np.fabs: "abs",
    np.sign: "sign",
    np.sqrt: "sqrt",
    np.exp: "exp",
    np.log: "log",
    np.tanh: "tanh",
    np.sin: "sin",
    np.cos: "cos",
    np.tan: "tan",
    np.arctan: "atan",
}

BINARY = {np.arctan2: "atan2", np.minimum: "min", np.fmin: "min", np.maximum: "max", np.fmax: "max"}

OPERATORS = {
    np.add: ("+", SUM),
    np.subtract: ("-", SUM),
    np.multiply: ("*", PRODUCT),
    np.true_divide: ("/", PRODUCT),
    np.power: ("^", POWER),
    np.float_power: ("^", POWER),
    np.less: ("<", COMPARISON),
    np.less_equal: ("<=", COMPARISON),
    np.greater: (">", COMPARISON),
    np.greater_equal: (">=", COMPARISON),
    np.equal: ("==", COMPARISON),
    np.not_equal: ("!=", COMPARISON),
    np.logical_and: ("&&", AND),
    np.bitwise_and: ("&&", AND),
    np.logical_or: ("||", OR),
    np.bitwise_or: ("||", OR),
}


class Symbol(np.lib.mixins.NDArrayOperatorsMixin):
    """An expression in the place of a number."""

    def __init__(self, text, binds=VALUE):
        self.text = text
        self.binds = binds

    def __repr__(self):
        return self.text

    def __bool__(self):
        raise TypeError(f"whether {self.text} holds is not known yet; write numpy.where(condition, a, b) in the place of `if`, `and`, `or` and `not`")

    def _number(self, *_):
        raise TypeError(f"{self.text} is no number yet; use the functions of numpy in the place of those of math")

    __float__ = __int__ = __index__ = __complex__ = _number

    def __iter__(self):
        raise TypeError(f"{self.text} is one number, and has no members")

    def __array_ufunc__(self, ufunc, method, *arguments, out=None, **options):
        if method != "__call__" or out is not None or options:
            return NotImplemented
        if ufunc in OPERATORS:
            return _between(*OPERATORS[ufunc], *arguments)
        if ufunc in UNARY or ufunc in BINARY:
            return _call(UNARY.get(ufunc) or BINARY[ufunc], *arguments)
        if ufunc is np.negative:
            return Symbol(f"-{_text(arguments[0], SIGN)}", SIGN)
        if ufunc is np.positive:
            return arguments[0]
        if ufunc in (np.logical_not, np.invert):
            return Symbol(f"!{_text(arguments[0], VALUE)}", SIGN)
        if ufunc is np.square:
            return _between("^", POWER, arguments[0], 2)
        raise TypeError(f"numpy.{ufunc.__name__} has no counterpart in an effect; there are {_functions()}")

    def __array_function__(self, function, _, arguments, options):
        if function is np.where and len(arguments) == 3:
            return _call("if", *arguments)
        if function is np.clip:
            names = ("a", "a_min", "a_max")
            given = {**options, **dict(zip(names, arguments))}
            low, high = (given.get(name, given.get(name[2:])) for name in names[1:])
            inner = given["a"] if low is None else _call("max", given["a"], low)
            return inner if high is None else _call("min", inner, high)
        raise TypeError(f"numpy.{function.__name__} has no counterpart in an effect; there are {_functions()}")


def _functions():
    ufuncs = [ufunc.__name__ for ufunc in (*UNARY, *BINARY)]
    return "numpy." + ", ".join(sorted({*ufuncs, "where", "clip", "square"}))


def _text(value, least):
    """An argument of an operator that binds as ``least``."""
    if isinstance(value, Symbol):
        return value.text if value.binds >= least else f"({value.text})"
    if isinstance(value, (bool, np.bool_)):
        return str(int(value))
    if np.ndim(value) != 0 or not np.isfinite(value := float(value)):
        raise TypeError(f"{value!r} is no finite number, and an effect has one value at a time")
    text = str(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)
    return f"({text})" if value < 0 else text


def _between(operator, binds, left, right):
    # A power takes its exponent from the right; after a comparison another one needs brackets.
    closed = operator == "^" or binds == COMPARISON
    text = f"{_text(left, binds + closed)} {operator} {_text(right, binds + 1 if operator != '^' else POWER)}"
    return Symbol(text.replace(" ^ ", "^") if operator == "^" else text, binds)


def _call(name, *arguments):
    return Symbol(f"{name}({', '.join(_text(argument, OR) for argument in arguments)})")


class Effect:
    """An effect of one's own. Called, it is the function that it was made of."""

    def __init__(self, function, definition):
        self.function = function
        self.definition = definition
        self.name = definition["name"]
        self.__doc__ = function.__doc__

    def __call__(self, *arguments, **options):
        return self.function(*arguments, **options)

    def __repr__(self):
        return self.text

    @property
    def text(self):
        """As it stands in an effect file."""
        return effects_text([self.definition])

    def save(self, path):
        """Writes an effect file, which ``acm-eval close-loop --effects`` reads."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.text)


def effect(function=None, *, place, form="static", parameters, inputs=None, constants=None, output=None, start=None, **more):
    """Makes an effect of a function whose arguments are named as in an effect file.

    ``place`` is ``"actuators"``, ``"outputs"`` or ``"frame"``. The function returns the column as it leaves (``form="static"``), or a dictionary of
    each state: its next value (``form="update"``) or its time derivative (``form="rate"``); a function of one state may return its value alone.
    ``output`` is a function of the column as it leaves, from the states; left out, it is the one state. ``start`` holds the states at the first sample.
    ``parameters``, ``inputs``, ``constants`` and further keys are those of an effect file.
    """
    if function is None:
        given = dict(place=place, form=form, parameters=parameters, inputs=inputs, constants=constants, output=output, start=start, **more)
        return lambda function: effect(function, **given)
    if form not in ("static", "update", "rate"):
        raise TypeError(f'form is {form!r}; write "static", "update" or "rate"')
    if place not in COLUMNS:
        raise TypeError(f'place is {place!r}; write "actuators", "outputs" or "frame"')
    named = {*COLUMNS[place], *KNOWN, *parameters, *(inputs or {}), *(constants or {})}
    states = [name for name in _arguments(function) if name not in named]
    if form == "static" and states:
        what = ", ".join(f"`{name}`" for name in states)
        raise TypeError(f"{function.__name__}: {what} is no column, input, parameter or constant; there are {', '.join(sorted(named))}")
    definition = {"name": function.__name__, "meaning": _first_line(function), "place": place, **more}
    if form == "static":
        definition["static"] = _outputs(function, function(**_symbols(function)))
    else:
        definition[form] = _states(function, states)
        definition["output"] = _output(function, output, states)
        if start is not None:
            definition["start"] = {state: _value(value) for state, value in _table(start, states).items()}
    for key, value in (("inputs", inputs), ("constants", constants), ("parameters", parameters)):
        if value:
            definition[key] = value
    definition = plain(definition)
    effects_text([definition])
    return Effect(function, definition)


def _first_line(function):
    lines = (function.__doc__ or "").strip().splitlines()
    return lines[0].rstrip(".") if lines else ""


def _arguments(function):
    kinds = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
    arguments = inspect.signature(function).parameters.values()
    if any(argument.kind not in kinds for argument in arguments):
        raise TypeError(f"{function.__name__}: give each argument a name, without * and /")
    return [argument.name for argument in arguments]


def _symbols(function):
    return {name: Symbol(name) for name in _arguments(function)}


def _value(value):
    if isinstance(value, str):
        return value
    if callable(value):
        return _text(value(**_symbols(value)), OR)
    return _text(value, OR)


def _outputs(function, answer):
    if isinstance(answer, dict):
        return {str(name): _text(value, OR) for name, value in answer.items()}
    if answer is None:
        raise TypeError(f"{function.__name__} returns nothing; return the column as it leaves")
    return _text(answer, OR)


def _table(values, states):
    return values if isinstance(values, dict) or len(states) != 1 else {states[0]: values}


def _states(function, states):
    answer = _table(function(**_symbols(function)), states)
    if not isinstance(answer, dict) or set(answer) != set(states) or not states:
        told = ", ".join(f"`{state}`" for state in states) or "none"
        raise TypeError(f"{function.__name__}: return a dictionary with a value for each state; the states among its arguments are {told}")
    return {state: _text(answer[state], OR) for state in states}


def _output(function, output, states):
    if output is None and len(states) != 1:
        raise TypeError(f"{function.__name__} has {len(states)} states; give `output`, a function of the column as it leaves")
    if output is None:
        return states[0]
    return output if isinstance(output, str) else _outputs(output, output(**_symbols(output)))
