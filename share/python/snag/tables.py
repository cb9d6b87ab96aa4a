"""Tables of numbers as Snag writes them: the first line holds `name [unit]` of each column."""
import csv
import io
import pathlib

import numpy


def name_and_unit(column):
    """"head [m]" -> ("head", "m"); without a unit ("head", "")."""
    name, _, unit = column.partition(" [")
    return name, unit.removesuffix("]")


def read_columns(file):
    """Names, units and values [row][column] of a monitor. A last line that a run has not finished is left out."""
    head, _, rows = pathlib.Path(file).read_text().partition("\n")
    names, units = zip(*map(name_and_unit, next(csv.reader([head]))))  # a name with a comma, as of a patch, is in quotes
    whole = rows[: rows.rfind("\n") + 1]
    values = numpy.loadtxt(io.StringIO(whole), delimiter=",", ndmin=2) if whole else numpy.empty((0, len(names)))
    return list(names), list(units), values


def frame(file):
    """A monitor as a data frame; attrs["units"] has the unit of each column."""
    import pandas

    names, units, values = read_columns(file)
    table = pandas.DataFrame(values, columns=names)
    table.attrs["units"] = dict(zip(names, units))
    return table


def label(table, column):
    """Name and unit of a column for the axis of a plot: "head [m]"; a pure number has no unit."""
    unit = table.attrs.get("units", {}).get(column, "1")
    return column if unit in ("", "1") else f"{column} [{unit}]"


def existing(file, what):
    """The path; an error that says what would have written the file where it is not there."""
    file = pathlib.Path(file)
    if not file.is_file():
        raise FileNotFoundError(f"{file} is not there; {what} writes it")
    return file
