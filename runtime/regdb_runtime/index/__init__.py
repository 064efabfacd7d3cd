"""The compiled index: from the rules of one place, day and transition to one fast function over a flat list of facts.

    regulations of a place and day
         |
     bucket          the rules that concern one transition; which stand alone, which defeat each other
         |
     conjuncts       when and not unless -> parts that must all be possible
        / \\
 generated  bitmaps  up to 256 rules: one Python function; beyond: bitmaps per fact, then exact closures
        \\ /
     settle          defeat among the rules that may hold
         |
     verdict, deciding rules, limits in force

`slots` turns scene and plan into the flat list, `closures` holds exact three-valued functions, `guarded` fails closed.
"""
