"""Recorded sessions in the formats of others. The command line; see vibe_sessions."""

from vibe_sessions.export import options

from . import cli


def parse(words):
    made = cli.Parser("export", "BAG... --to LIST --output DIR [options]", options.DESCRIPTION, options.EPILOG)
    options.add_options(made.options)
    arguments = made.parse(words)
    options.check(arguments, made.error)
    arguments.fail = made.error
    return arguments


def parts(arguments):
    return ["session", "python"] if "lerobot" in arguments.to else ["session"]


def run(arguments):
    from vibe_sessions.export.main import run as export

    return export(arguments, arguments.fail)
