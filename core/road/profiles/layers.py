"""Layers of the points of cells: where heights jump, what lies above is no ground."""

import numpy as np

GHOST_SHARE = 0.15  # a lowest layer with less than this share of its cell is multipath, not ground


def lowest_layers(place, h, layer_jump):
    """Which points are ground; first index and count of the lowest real layer of every occupied cell."""
    if not len(place):
        empty = np.empty(0, np.int64)
        return np.empty(0, bool), empty, empty
    new_cell, new_layer = np.ones(len(place), bool), np.ones(len(place), bool)
    np.not_equal(place[1:], place[:-1], out=new_cell[1:])
    np.greater(h[1:] - h[:-1], layer_jump, out=new_layer[1:])
    new_layer |= new_cell
    layer_start = np.flatnonzero(new_layer)
    layer_count = np.diff(layer_start, append=len(place))
    first_of_cell = new_cell[layer_start]
    ground = np.ones(len(place), bool)
    if first_of_cell.all():
        return ground, layer_start, layer_count
    layer_cell = np.cumsum(first_of_cell) - 1
    cell_count = np.bincount(layer_cell, layer_count)
    real = layer_count >= GHOST_SHARE * cell_count[layer_cell]
    chosen = np.flatnonzero(real)
    chosen = chosen[np.r_[True, np.diff(layer_cell[chosen]) > 0]]
    other = np.ones(len(layer_start), bool)
    other[chosen] = False
    ground[expand(layer_start[other], layer_start[other] + layer_count[other])[1]] = False
    return ground, layer_start[chosen], layer_count[chosen]


def expand(start, end):
    """Every index of ragged ranges, and which range it belongs to: (N,) owners and (N,) indices."""
    length = np.maximum(end - start, 0)
    owner = np.repeat(np.arange(len(start)), length)
    index = np.arange(len(owner))
    index += np.repeat(start - (np.cumsum(length) - length), length)
    return owner, index
