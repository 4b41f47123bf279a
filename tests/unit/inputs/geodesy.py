"""Geodesy by textbook formulas, apart from the library that the readers use: WGS 84 to Earth-fixed axes and back."""

import numpy as np

A_M, FLATTENING = 6_378_137.0, 1 / 298.257_223_563
E2 = FLATTENING * (2 - FLATTENING)


def ecef(geodetic):
    """Earth-fixed x, y, z (m) of latitude, longitude (deg), height (m); (..., 3)."""
    latitude, longitude = np.deg2rad(geodetic[..., 0]), np.deg2rad(geodetic[..., 1])
    normal = A_M / np.sqrt(1 - E2 * np.sin(latitude) ** 2)
    across = (normal + geodetic[..., 2]) * np.cos(latitude)
    along = (normal * (1 - E2) + geodetic[..., 2]) * np.sin(latitude)
    return np.stack([across * np.cos(longitude), across * np.sin(longitude), along], axis=-1)


def geodetic_of(xyz):
    """The inverse of `ecef` near the ground, by iteration to the last digit."""
    across = np.hypot(xyz[..., 0], xyz[..., 1])
    latitude = np.arctan2(xyz[..., 2], across * (1 - E2))
    for _ in range(12):
        normal = A_M / np.sqrt(1 - E2 * np.sin(latitude) ** 2)
        height = across * np.cos(latitude) + xyz[..., 2] * np.sin(latitude) - A_M**2 / normal
        latitude = np.arctan2(xyz[..., 2], across * (1 - E2 * normal / (normal + height)))
    longitude = np.arctan2(xyz[..., 1], xyz[..., 0])
    return np.stack([np.rad2deg(latitude), np.rad2deg(longitude), height], axis=-1)


def axes(geodetic):
    """Unit vectors north, east, down in Earth-fixed axes, as columns; (..., 3, 3)."""
    latitude, longitude = np.deg2rad(geodetic[..., 0]), np.deg2rad(geodetic[..., 1])
    up = np.stack(
        [np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)], axis=-1
    )
    east = np.stack([-np.sin(longitude), np.cos(longitude), np.zeros_like(latitude)], axis=-1)
    return np.stack([np.cross(up, east), east, -up], axis=-1)
