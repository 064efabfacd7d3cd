"""The vehicle's side: database and scene in, decision out.

 regulations.sqlite
      |
 rows             rows -> vocabulary, states, jurisdictions, regulations, each read once and checked
      |
 index            rules of a transition -> one function over a flat list of facts
      |
 verdict          the answer: rules, limits, what is unknown, what was assumed; reasons on demand
      |
 legality         law of a place and day: scene, plan -> verdict
      |
 database         the opened file: `RegulationDatabase.open(path).at(place, date).judge(scene, plan)`
      |
 commands         check, explain
"""
