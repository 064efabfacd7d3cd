"""A LLaVA of a few thousand random weights, with a tokenizer of a few words, saved as a real one is: for the client, not for its words."""

from __future__ import annotations

from pathlib import Path

WORDS = ("<pad>", "<s>", "</s>", "<unk>", "<image>", "USER", ":", "ASSISTANT", "Examine", "the", "light", "is", "red", "green", "a", "stop", "sign")
TEMPLATE = (
    "{% for turn in messages %}{{ turn['role'] | upper }} : {% for part in turn['content'] %}"
    "{% if part['type'] == 'image' %}<image>\n{% else %}{{ part['text'] }}{% endif %}{% endfor %} {% endfor %}"
    "{% if add_generation_prompt %}ASSISTANT :{% endif %}"
)


def save_tiny_llava(folder: Path, *, template: bool = True) -> Path:
    """Write model and processor into a folder; a few dozen kilobytes."""
    import torch
    from transformers import CLIPVisionConfig, LlamaConfig, LlavaConfig, LlavaForConditionalGeneration

    size = {"hidden_size": 16, "intermediate_size": 32, "num_hidden_layers": 2, "num_attention_heads": 2}
    vision = CLIPVisionConfig(**size, image_size=28, patch_size=14, projection_dim=16)
    words = LlamaConfig(**size, vocab_size=len(WORDS), num_key_value_heads=2, max_position_embeddings=4096, eos_token_id=2, pad_token_id=0)
    torch.manual_seed(5)
    config = LlavaConfig(vision_config=vision, text_config=words, image_token_index=WORDS.index("<image>"), vision_feature_layer=-1)
    LlavaForConditionalGeneration(config).save_pretrained(folder)
    _processor(template).save_pretrained(folder)
    return folder


def _processor(template: bool) -> object:
    from tokenizers import Tokenizer
    from tokenizers.models import WordLevel
    from tokenizers.pre_tokenizers import Whitespace
    from transformers import LlavaProcessor, PreTrainedTokenizerFast
    from transformers.models.clip.image_processing_pil_clip import CLIPImageProcessorPil

    tokenizer = Tokenizer(WordLevel({word: place for place, word in enumerate(WORDS)}, unk_token="<unk>"))
    tokenizer.pre_tokenizer = Whitespace()
    fast = PreTrainedTokenizerFast(
        tokenizer_object=tokenizer, unk_token="<unk>", pad_token="<pad>", bos_token="<s>", eos_token="</s>", additional_special_tokens=["<image>"]
    )
    pictures = CLIPImageProcessorPil(size={"shortest_edge": 28}, crop_size={"height": 28, "width": 28})
    return LlavaProcessor(
        image_processor=pictures, tokenizer=fast, patch_size=14, vision_feature_select_strategy="default", num_additional_image_tokens=1,
        chat_template=TEMPLATE if template else None,
    )  # fmt: skip
