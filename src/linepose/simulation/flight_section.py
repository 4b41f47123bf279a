"""A simulated flight over textured ground: the `flight` section of a platform file."""

from typing import Annotated

import numpy as np
from pydantic import Field, NonNegativeFloat, NonNegativeInt, PositiveFloat

from linepose.arrays import Floats
from linepose.geometry import rotations
from linepose.settings import Settings
from linepose.simulation.flight_layouts import Strip
from linepose.simulation.settings import NavigationErrorSettings, ReportedSettings, Triple

Share = Annotated[float, Field(ge=0, le=1)]


class StripSection(Settings):
    """One straight strip, given by its middle."""

    north_m: float = Field(description="North of its middle (m).")
    east_m: float = Field(description="East of its middle (m).")
    heading_deg: float = Field(description="Direction of flight, clockwise from north (deg).")
    height_m: PositiveFloat = Field(description="Height of the body above the ground's zero (m).")
    duration_s: PositiveFloat = Field(le=600, description="How long it takes (s).")

    @property
    def strip(self) -> Strip:
        """The same as the simulation takes it."""
        return Strip(self.north_m, self.east_m, float(np.deg2rad(self.heading_deg)), self.height_m, self.duration_s)


class TexturedGroundSection(Settings):
    """The ground: smooth relief, and a texture of several grains; rows of a crop where they are asked for."""

    relief_m: NonNegativeFloat = Field(1.0, le=10, description="Sigma of its heights about zero (m).")
    relief_wavelength_m: PositiveFloat = Field(25.0, ge=5, description="Longest wavelength of the relief (m).")
    grain_m: PositiveFloat = Field(0.15, description="Finest grain of the texture (m).")
    contrast: Share = Field(0.8, description="Of the texture, as a share of its mean.")
    rows_m: PositiveFloat | None = Field(
        None, description="Distance of a crop's rows, all alike, if there are any (m)."
    )


class FlightErrorSection(Settings):
    """Sigmas of the navigation's errors, which drift, as reported; a share of them is white besides."""

    position_m: NonNegativeFloat = Field(0.02, description="Of each coordinate (m).")
    roll_pitch_deg: NonNegativeFloat = Field(0.02, description="Of roll and pitch (deg).")
    yaw_deg: NonNegativeFloat = Field(0.06, description="Of yaw (deg).")
    correlation_time_s: PositiveFloat = Field(60.0, description="How long they stay alike (s).")
    white_share: Share = Field(0.3, description="Share of each sigma that is white from one solution to the next.")

    @property
    def reported(self) -> ReportedSettings:
        """The sigmas that the log states."""
        tilt, yaw = np.deg2rad([self.roll_pitch_deg, self.yaw_deg]).tolist()
        return ReportedSettings((self.position_m,) * 3, (tilt, tilt, yaw))

    @property
    def errors(self) -> NavigationErrorSettings:
        """The true errors."""
        reported = self.reported

        def white(sigma: Triple) -> Triple:
            return (self.white_share * sigma[0], self.white_share * sigma[1], self.white_share * sigma[2])

        return NavigationErrorSettings(
            gauss_markov_position_m=reported.position_m,
            gauss_markov_euler_rad=reported.euler_rad,
            correlation_time_s=self.correlation_time_s,
            white_position_m=white(reported.position_m),
            white_euler_rad=white(reported.euler_rad),
        )


class FlightSection(Settings):
    """A simulated flight in strips over textured ground with relief, with a known truth: its scans are rendered."""

    seed: NonNegativeInt = Field(description="Of every random number.")
    true_position_m: Triple = Field(description="The camera's true position in the body (m).")
    true_euler_deg: Triple = Field(description="Its true rotation, camera to body: roll, pitch, yaw (deg).")
    strips: tuple[StripSection, ...] = Field(min_length=1, description="The strips, one scan each, in their order.")
    speed_m_s: PositiveFloat = Field(5.0, description="Speed over ground (m/s).")
    turn_s: PositiveFloat = Field(10.0, description="Time from one strip to the next (s).")
    line_rate_hz: PositiveFloat = Field(100.0, le=2000, description="Lines a second.")
    navigation_rate_hz: PositiveFloat = Field(100.0, le=2000, description="Solutions a second in the log.")
    ground: TexturedGroundSection = Field(TexturedGroundSection(), description="The ground.")
    navigation_error: FlightErrorSection = Field(FlightErrorSection(), description="The navigation's errors.")
    lateness_lines: NonNegativeFloat = Field(
        0.0, le=0.15, description="Sigma of the time stamps' error, each for itself (lines)."
    )
    start_time_us: NonNegativeInt = Field(1_466_000_000_000_000, description="When the flight begins (us since 1970).")
    origin_m: Triple = Field((6_248_550.0, 332_965.0, -42.0), description="Of the map's north, east, down (m).")

    @property
    def true_pose(self) -> Floats:
        """The camera's true pose in the body (6,), with a rotation vector."""
        turn = rotations.matrix_from_euler(np.deg2rad(self.true_euler_deg))
        return np.concatenate([self.true_position_m, rotations.rotation_vector_from_matrix(turn)])
