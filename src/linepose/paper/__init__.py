"""The numbers of Wendel & Underwood (2017) beside those obtained: the only room that knows them."""
