"""One module for each offence; its docstring is the rule's page, `check(build)` finds it. `registry` lists them all."""
