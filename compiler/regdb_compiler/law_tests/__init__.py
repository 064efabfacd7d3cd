"""The law's own tests: read from the codes, judged by the reference meaning, counted for coverage, reported.

    read -> take_part -> judge -> outcome -> coverage, to_text, to_json, to_junit
"""
