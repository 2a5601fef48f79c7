"""The tables that scripts/accuracy writes into the pages: each is made from the result files alone."""

from measured_text import origin

TABLES = {}  # name in the pages: (section, what makes it)


def made_from(section):
    """A function from the store to (text, [(label, row)]): what stands in the pages, and the rows that it shows."""

    def add(make):
        TABLES[make.__name__] = (section, make)
        return make

    return add


def block(store, name):
    """What stands between the marks of a table: the table and the line on where it comes from."""
    section, make = TABLES[name]
    if not store.rows(section):
        return f"Not measured yet (`scripts/accuracy --section {section}`)."
    text, rows = make(store)
    return f"{text}\n\n{origin(store, section, rows)}" if rows else text
