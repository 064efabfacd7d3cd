"""Rules about what reads well and is still wrong: `rule` is one, `registry` lists them, `run` applies them to a build."""
