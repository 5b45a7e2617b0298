"""Conversion of units by the library UDUNITS, which the program uses too."""

import ctypes
import functools

from .mistakes import Mistake

UTF8 = 2  # UT_UTF8


@functools.cache
def _library():
    """Returns the library and its system of units."""
    try:
        library = ctypes.CDLL("libudunits2.so.0")
    except OSError:
        raise Mistake("a table with units needs the library UDUNITS: apt install libudunits2-0") from None
    for name in "ut_read_xml", "ut_parse", "ut_get_converter":
        getattr(library, name).restype = ctypes.c_void_p
    library.cv_convert_double.restype = ctypes.c_double
    library.ut_set_error_message_handler(library.ut_ignore)
    return library, ctypes.c_void_p(library.ut_read_xml(None))


@functools.cache
def factor(unit, other):
    """Returns a unit divided by another one, such as 1000 for mm and um; None if one is not known or the dimensions
    differ."""
    library, system = _library()
    units = [library.ut_parse(system, one.strip().encode("utf-8"), UTF8) for one in (unit, other)]
    converter = library.ut_get_converter(*map(ctypes.c_void_p, units)) if all(units) else None
    convert = functools.partial(library.cv_convert_double, ctypes.c_void_p(converter))
    one, two = (convert(ctypes.c_double(number)) for number in (1, 2)) if converter else (0, 0)
    return one if one > 0 and abs(two - 2 * one) <= 1e-9 * one else None  # no reciprocals, and no other zero
