"""Cauchy singular integral equations of any index."""
