"""How good it is.

In: a result and a reference. Out: precision, recall, errors and miscoding by the published protocols, and layers coloured by outcome.
"""
