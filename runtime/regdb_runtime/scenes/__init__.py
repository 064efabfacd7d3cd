"""Scenes: the facts of law for each piece of a path, from map, tracks, lights, clock and history.

 RoadMap ---> lane_facts, sign_facts, pieces          what stands still, cut where zones, signs and distances change the law
    |         junction_facts, crossing                junctions, and the ways through them that meet the planned one
    v
 LanePath --> course                                  parts of a path: pieces, stages of the junction, rails, the hour
    |
 Observation -> instant -> around, look, walkers      everybody placed once on each path
    |           traffic_roles, junction_roles, roles  who fills which role for a way to go; light_facts, clock_facts
    |           history                               the last seconds and metres
    v           eye_facts, merging                    what perception reports besides, the stricter of two tellers
 Scenes.stretches -> Stretch                          place, time, law, scene encoded once, roles for `Plan.facts`

`tellers` says of every fact of the vocabulary who tells it.
"""
