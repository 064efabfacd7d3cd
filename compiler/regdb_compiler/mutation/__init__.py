"""Mutation of the law's data: written law -> mutants -> which law test notices each -> what no test notices."""
