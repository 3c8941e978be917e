"""The commands of addon.farm within the test's process."""

from addon.farm.__main__ import main


def called(capsys, *words):
    """Run a command and return (exit code, standard output, standard error)."""
    try:
        code = main([str(word) for word in words])
    except SystemExit as ended:
        code = ended.code
    said = capsys.readouterr()
    return code, said.out, said.err
