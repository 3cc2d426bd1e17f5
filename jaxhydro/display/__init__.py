"""How models and motions are shown: texts, HTML tables, data frames, data sets and axes.

Methods of `Model`, `Response` and `Modes` call these functions, and import them only then.
"""
