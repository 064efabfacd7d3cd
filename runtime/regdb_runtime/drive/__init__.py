"""Drives: experiments in closed loop, their logs, figures and summaries."""
