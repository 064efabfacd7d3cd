"""A vision model on this machine through transformers: LLaVA, in 4 or 8 bits where there is a GPU, its answer bounded by the wall clock."""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Literal

from regdb_runtime.errors import MissingExtra, ModelError
from regdb_runtime.observation import Provenance
from regdb_runtime.perception.bounded import BoundedCalls, DeadlinePassed, StillBusy
from regdb_runtime.perception.crops import PictureError, PictureSettings, small_image
from regdb_runtime.perception.describer import Description, Failure, Frame, Prompt

Quantization = Literal["none", "8bit", "4bit"]
Device = Literal["auto", "cuda", "mps", "cpu"]

PURPOSE = "a vision model on this machine"


@dataclass(frozen=True)
class LlavaSettings:
    """One model and how it is loaded.

    `model`: a folder, or a name on the Hugging Face hub whose files are on this machine already; only with `download` are they fetched.
    `quantization` needs a CUDA GPU and bitsandbytes. `device` `auto`: CUDA, else Apple's, else the processor. `picture`: LLaVA-1.5 looks at
    336 x 336 pixels; its processor cuts the sides of a wide frame off, so frames are padded to a square, as the model was trained.
    """

    model: str = "llava-hf/llava-1.5-7b-hf"
    quantization: Quantization = "4bit"
    device: Device = "auto"
    download: bool = False
    picture: PictureSettings = field(default_factory=lambda: PictureSettings(longest=672, square=True))


@dataclass(frozen=True, slots=True)
class MeasuredRate:
    """A row of the paper's Table IV: frames a second at 1080p on an RTX 4070, from slowest to fastest."""

    model: str
    quantization: Quantization
    slowest: float
    fastest: float


PAPER_RATES: Mapping[str, MeasuredRate] = MappingProxyType({
    "7b-4bit": MeasuredRate("llava-hf/llava-1.5-7b-hf", "4bit", 2.0, 2.0),
    "7b-8bit": MeasuredRate("llava-hf/llava-1.5-7b-hf", "8bit", 0.5, 1.0),
    "13b-4bit": MeasuredRate("llava-hf/llava-1.5-13b-hf", "4bit", 1.0, 2.0),
    "13b-8bit": MeasuredRate("llava-hf/llava-1.5-13b-hf", "8bit", 0.2, 0.5),
})  # fmt: skip
"""Table IV. Of `below 2 Hz` and `below 0.5 Hz` the paper gives no lower end; the one here is what the deadline of a loop should allow for."""


def settings_of(row: str) -> LlavaSettings:
    """The settings of a row of Table IV. Raises ModelError for a row that is not there."""
    try:
        found = PAPER_RATES[row]
    except KeyError:
        raise ModelError(f"unknown model {row!r}; the paper measured: {', '.join(PAPER_RATES)}") from None
    return LlavaSettings(found.model, found.quantization)


def load_arguments(settings: LlavaSettings, device: str) -> dict[str, Any]:
    """How `from_pretrained` is called: number type, or the quantisation's configuration and its device. Raises ModelError, MissingExtra."""
    torch, transformers = _library("torch"), _library("transformers")
    found: dict[str, Any] = {"local_files_only": not settings.download}
    if settings.quantization == "none":
        return found | {"dtype": torch.float32 if device == "cpu" else torch.float16}
    if not device.startswith("cuda"):
        raise ModelError(f"{settings.quantization} loading needs a CUDA GPU; this machine offers {device}: load with quantization='none'")
    _library("bitsandbytes")
    return found | {"quantization_config": quantization_config(settings.quantization, transformers, torch), "device_map": {"": device}}


def quantization_config(quantization: Quantization, transformers: Any, torch: Any) -> Any:
    """The BitsAndBytesConfig of 4 bits (NF4, doubly quantised, computed in half precision) or 8 bits; None for neither."""
    if quantization == "4bit":
        return transformers.BitsAndBytesConfig(
            load_in_4bit=True, bnb_4bit_quant_type="nf4", bnb_4bit_use_double_quant=True, bnb_4bit_compute_dtype=torch.float16
        )
    return transformers.BitsAndBytesConfig(load_in_8bit=True) if quantization == "8bit" else None


def choose_device(wanted: Device, torch: Any) -> str:
    """The device a model is put on. Raises ModelError for one that this machine lacks."""
    there = {"cuda": bool(torch.cuda.is_available()), "mps": bool(torch.backends.mps.is_available()), "cpu": True}
    if wanted == "auto":
        return next(name for name, found in there.items() if found)
    if not there[wanted]:
        raise ModelError(f"this machine has no {wanted} device; there is: {', '.join(name for name, found in there.items() if found)}")
    return wanted


class LlavaDescriber:
    """Keeps the Describer protocol with a model in this process, loaded at construction.

    The model writes on a thread of its own; a criterion stops it at the deadline between two words, and whoever asked gets the failure then,
    also when a word takes longer. Until it has stopped, further calls fail at once. What was written until the deadline is thrown away: half
    a sentence may say the opposite of the whole. Raises MissingExtra, and ModelError when the model cannot be loaded.
    """

    provenance: Provenance = "live"

    def __init__(self, settings: LlavaSettings | None = None) -> None:
        self.settings = settings or LlavaSettings()
        self._torch = _library("torch")
        self.device = choose_device(self.settings.device, self._torch)
        self._processor, self._model = _load(self.settings, self.device)
        self._calls = BoundedCalls("vision-model")
        self._stopped = False

    def describe(self, frame: Frame, prompt: Prompt, deadline: float) -> Description:
        """Ask once. Never raises, never outlasts `deadline` (wall-clock seconds from now)."""
        began = time.monotonic()
        if self._stopped:
            return self._failed("cancelled", "the client is closed", began)
        given_up = [False]

        def too_late() -> bool:
            return given_up[0] or self._stopped or time.monotonic() - began > deadline

        def give_up() -> None:
            given_up[0] = True

        try:
            text, usage, cut = self._calls.call(lambda: self._write(frame, prompt, too_late), deadline, give_up)
        except StillBusy:
            return self._failed("deadline", "the call before has not ended yet", began)
        except (DeadlinePassed, TimeoutError):
            return self._failed("cancelled" if self._stopped else "deadline", f"no answer within {deadline:g} s", began)
        except PictureError as error:
            return self._failed("malformed", str(error), began)
        except Exception as error:  # noqa: BLE001  # a client never raises
            return self._failed("malformed", f"{type(error).__name__}: {error}", began)
        if not text:
            return self._failed("malformed", "the model said nothing", began)
        return Description(text, took=time.monotonic() - began, model=self.settings.model, usage=usage, cut=cut)

    def close(self) -> None:
        """Stop writing, and answer nothing more."""
        self._stopped = True

    def _failed(self, failure: Failure, detail: str, began: float) -> Description:
        return Description("", failure, detail, time.monotonic() - began, self.settings.model)

    def _write(self, frame: Frame, prompt: Prompt, too_late: Callable[[], bool]) -> tuple[str, Mapping[str, int], bool]:
        """The model's words, their count, and whether they were cut off by the greatest length. Raises TimeoutError."""
        image = small_image(frame, prompt.crop, self.settings.picture)
        inputs = self._processor(images=image, text=self._question(prompt), return_tensors="pt").to(self.device, self._model.dtype)
        asked = int(inputs["input_ids"].shape[1])

        def stop(input_ids: Any, scores: Any, **_: Any) -> Any:  # noqa: ARG001  # as transformers calls it
            return self._torch.full((input_ids.shape[0],), too_late(), dtype=self._torch.bool, device=input_ids.device)

        with self._torch.inference_mode():
            out = self._model.generate(**inputs, max_new_tokens=prompt.max_tokens, do_sample=False, stopping_criteria=[stop])
        if too_late():
            raise TimeoutError
        words = out[0, asked:]
        text = str(self._processor.decode(words, skip_special_tokens=True)).strip()
        ended = int(words[-1]) in _ends(self._model.generation_config.eos_token_id) if len(words) else True
        return text, {"prompt_tokens": asked, "completion_tokens": len(words)}, len(words) >= prompt.max_tokens and not ended

    def _question(self, prompt: Prompt) -> str:
        """The chat template's form of the prompt; that of LLaVA-1.5 where the model brings none."""
        shown = [{"type": "image"}, {"type": "text", "text": prompt.text}]
        turns = [
            {"role": role, "content": [{"type": "text", "text": text}]}
            for question, answer in prompt.history for role, text in (("user", question), ("assistant", answer))
        ]  # fmt: skip
        if getattr(self._processor, "chat_template", None):
            return str(self._processor.apply_chat_template([*turns, {"role": "user", "content": shown}], add_generation_prompt=True, tokenize=False))
        earlier = "".join(f"USER: {question} ASSISTANT: {answer}</s>" for question, answer in prompt.history)
        return f"{earlier}USER: <image>\n{prompt.text} ASSISTANT:"


def _ends(token: object) -> tuple[int, ...]:
    """The tokens that end an answer: one, several, or none."""
    if isinstance(token, int):
        return (token,)
    return tuple(token) if isinstance(token, (list, tuple)) else ()


def _library(name: str) -> Any:
    """A large library, imported only here. Raises MissingExtra with the command that installs it."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise MissingExtra(name, "local-vlm", PURPOSE) from error


def _load(settings: LlavaSettings, device: str) -> tuple[Any, Any]:
    """Processor and model, ready to write. Raises ModelError, MissingExtra."""
    transformers = _library("transformers")
    arguments = load_arguments(settings, device)
    try:
        processor = transformers.AutoProcessor.from_pretrained(settings.model, local_files_only=not settings.download)
        model = transformers.AutoModelForImageTextToText.from_pretrained(settings.model, **arguments)
    except (OSError, ValueError, KeyError, RuntimeError) as error:
        said = str(error).strip().split("\n")[0]
        fetch = "" if settings.download else f"; fetch it first: hf download {settings.model}"
        raise ModelError(f"{settings.model} cannot be loaded: {said}{fetch}") from error
    return processor, (model if settings.quantization != "none" else model.to(device)).eval()
