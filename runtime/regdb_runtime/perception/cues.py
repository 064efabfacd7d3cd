"""The words by which English denies, supposes, advises or dates what it says: data of the context layer, in the forms the tokens have."""

from __future__ import annotations

from regdb_runtime.perception.word_set import word_set

CUES: dict[str, tuple[str, ...]] = {
    "negation": (
        "no", "nobody", "without", "free of", "free from", "absence of", "lack of", "lack", "lacking", "devoid of", "neither", "nor",
        "none of", "clear of", "empty of", "instead of", "rather than", "not any",
    ),
    "not": (
        "not", "never",
    ),
    "denied_after": (
        "not visible", "not present", "absent", "not in sight", "not seen", "not in view", "missing", "nowhere", "not shown",
        "not detected", "not currently visible", "not exist", "nonexistent", "not found", "not be seen", "not observed", "not depicted",
        "not evident", "not apparent", "not in the image", "not clearly visible", "not in the scene", "not in the frame", "not available",
        "not displayed", "none", "no", "not applicable", "not identified", "invisible", "not readily visible", "0", "false", "not noticed",
        "not spotted", "not discernible", "not included", "not there", "not immediately visible", "not directly visible", "not noted",
    ),
    "unsure": (
        "not clear", "unclear", "not sure", "unsure", "not tell", "not possible to determine", "not possible to tell", "not determine",
        "unable to determine", "hard to tell", "difficult to tell", "difficult to determine", "not certain", "uncertain",
        "not be determined", "not know", "unknown whether", "not confirm", "whether", "not specify", "not provide enough", "not obviou",
    ),
    "condition": (
        "if", "in case", "should the", "should a", "should any", "unless", "provided that", "as long as", "in the event", "whenever",
        "assuming", "suppose", "imagine", "even if", "otherwise",
    ),
    "when": (
        "when", "once", "as soon as",
    ),
    "until": (
        "until", "till", "wait for", "waiting for", "prior to", "anticipating", "in anticipation of",
    ),
    "future": (
        "will", "about to", "going to", "soon", "expected to", "would", "eventually", "to turn", "to change", "to become", "before it turn",
        "before it", "before turning", "wait to", "should turn", "waiting to", "change to", "supposed to",
    ),
    "ended": (
        "no longer", "have crossed", "finished crossing", "cleared", "passed", "have left", "had left", "past the", "exited", "exiting",
        "leaving", "used to be", "ended", "after passing", "having passed", "behind us", "previously", "formerly", "after crossing",
        "after clearing", "just left",
    ),
    "ended_after": (
        "have disappeared", "have been removed", "have ended", "have cleared", "be gone", "have gone", "be over", "have been cleared",
        "have gone away", "have moved away", "have left", "have finished", "was removed", "were removed", "is gone", "are gone", "is over",
        "have reopened", "have stopped falling", "have lifted", "have been lifted",
    ),
    "other": (
        "cross traffic", "oncoming traffic", "opposing traffic", "oncoming vehicle", "oncoming car", "cross street", "side street",
        "other direction", "opposite direction", "pedestrian", "other vehicle", "other car", "bus", "tram", "cyclist", "bicycle", "train",
        "truck", "crossing traffic", "left turning traffic", "turning traffic", "opposing direction", "motorcycle", "van",
        "opposing vehicle", "perpendicular traffic", "conflicting traffic", "other driver", "other lane", "adjacent lane",
        "other road user", "taxi", "streetcar",
    ),
    "advice": (
        "watch for", "watch out for", "watching for", "watching out for", "look out for", "looking out for", "lookout for", "look for",
        "looking for", "beware of", "aware of", "cautious of", "cautious about", "mindful of", "alert for", "alert to", "prepared for",
        "prepare for", "ready for", "check for", "checking for", "watchful for", "watchful of", "yield to", "yielding to", "give way to",
        "wary of", "attention to", "ensure", "make sure", "ensuring", "making sure", "careful of", "careful with", "stop for", "yield for",
        "attentive to", "vigilant for", "vigilant of", "eye out for", "scan for", "anticipate", "consider", "monitor", "monitoring",
        "avoid", "avoiding", "beware", "respond to", "react to", "respect", "obey", "adhere to", "comply with", "prepared to stop for",
        "caution for", "account for", "priority to", "right of way to", "look both way for", "slow down for", "lookout", "observe",
    ),
    "modal": (
        "should", "must", "need to", "have to", "ought to", "required to", "advised to", "recommended to", "advisable to", "important to",
        "necessary to", "let", "please", "always", "remember to", "essential to", "crucial to", "best to", "required", "be", "stay",
        "remain", "keep", "shall", "will", "would",
    ),
    "generic": (
        "driver must", "vehicle must", "driver should", "vehicle should", "in general", "generally", "typically", "usually", "by law",
        "law require", "traffic rule", "traffic law", "rule of the road", "used to control", "used to indicate", "used for", "designed to",
        "control the flow", "in most", "require driver", "even with", "meant to", "intended to", "often", "normally", "common to",
        "such as", "purpose of", "in many", "indicate that vehicle", "indicating that vehicle", "indicating that driver", "signify",
        "regulate", "every driver", "all driver", "driver are", "help to", "serve to", "like",
    ),
    "hedge": (
        "may", "might", "possibly", "possible", "likely", "could", "perhaps", "probably", "maybe", "presumably", "potentially", "potential",
        "suggest", "suggesting", "some kind of", "some form of", "some sort of", "unlikely", "possibility of", "probable", "i think",
        "i guess", "risk of", "chance of", "as if",
    ),
    "break": (
        "but", "however", "although", "though", "except", "while", "whereas", "because", "since", "which", "who", "where", "that", "so",
        "indicating", "allowing", "making", "therefore", "thus", "yet", "then", "besides", "apart from", "other than", "aside from",
        "hence", "due to", "as", "to", "resulting", "if", "meaning",
    ),
}  # fmt: skip
"""Kind of cue -> its phrases."""

PLACES = word_set(
    """at in on near along around from with through behind beside within across toward into by alongside ahead before during under over next
    for between"""
)
"""Prepositions that end the reach of `no`: what stands after them is where, not what."""

HEARTS = word_set("sight view image vicinity scene picture frame area photo background foreground distance way")
"""After a preposition these name no place of their own, so a list goes on after them."""

TAKES_OBJECT = word_set(
    """have see show contain include feature depict notice spot observe detect display any a an there identify find seeing showing indicate"""
)
"""After `not` these deny what follows them: `does not show a stop sign`; after other verbs only the verb is denied."""

NO_DENIAL = word_set("need reason doubt matter problem issue longer way choice delay hurry change only later")
"""After `no` or `not` these deny nothing about the scene."""

OPENERS = word_set("the a an it there this i we our they he she you another")
"""After `and` these begin a new clause, which a denial does not reach."""

ASKING = word_set("what is are was were do does did which how why where who when can could should would will has have shall")
"""A clause that begins with one of these, in a sentence that ends with a question mark, asks."""

DEFINITE = word_set(
    """the this these those our its their his her my your current a an one another several two three four five many some multiple both 1 2 3 4
    5 6 7 8"""
)
"""Before a noun these say that it is there; a bare plural after advice does not."""

POINTING = word_set("the this that these those our its their his her my")
"""Before a noun these say that it is known already; `may` behind it doubts something else."""

NOT_PAST = word_set(
    """red need speed bed feed shed proceed exceed succeed indeed advised recommended required needed supposed prepared expected allowed
    permitted prohibited used located marked signalized designated dedicated divided parked posted colored limited restricted controlled"""
)
"""Words in -ed that tell no story."""

WEAK_ADVICE = frozenset((
    "yield to", "yielding to", "give way to", "stop for", "yield for", "slow down for", "avoid", "avoiding", "monitor", "monitoring", "observe",
    "respond to", "react to", "obey", "respect", "account for", "priority to", "consider", "attention to", "ensure", "anticipate",
))  # fmt: skip
"""Advice only as an order or with a modal: `the car yields to pedestrians` says that they are there."""
