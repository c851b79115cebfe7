"""Pictures and tables: methods of results for which what lies above is imported when it is asked for."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..model import checks

if TYPE_CHECKING:  # names for annotations; at run time only the methods import from above
    from ..viz.pictures.animation import Animation
    from ..viz.pictures.picture import Picture
    from ..viz.view.frame import Framed


def _labels(points: Sequence[Any] | None) -> list[str] | None:
    """Points, objects or labels, one or several, as labels."""
    if points is None:
        return None
    several = points if isinstance(points, list | tuple) else [points]
    return [str(getattr(point, "label", None) or getattr(point, "name", point)) for point in several]


class Plotted:
    """What has a history: a Result and its sensors."""

    def plot(
        self,
        *what: Any,
        quantity: str | None = None,
        x: str = "t",
        plane: str | None = None,
        size: tuple[float, float] | None = None,
    ) -> Picture:
        """Draw curves over time, or paths; without anything given the energies and how their balance drifts.

        Parameters
        ----------
        *what : Point, PointMass, RigidBody, Spring, Contact, joint, support or str
            Points, springs, contacts, joints or supports, as objects of the model or by name: "beam.end".
        quantity : str
            What to ask of them: "position" (default of points), "velocity", "speed", "tension", "strain",
            "curvature", "bending_moment", "torque" or "twist" of points; "spring_force" (default) or
            "spring_length" of springs; "contact_force" (default), "contact_gap" or "arc_length" of
            contacts; "arc_length" (default), "arc_rate", "normal_force" or "sliding_friction" of sliding
            joints; "joint_force" (default), "joint_moment", "multiplier", "joint_angle", "joint_rate",
            "joint_angles", "joint_rates", "joint_displacement" or "joint_velocity" of joints;
            "reaction" (default) or "reaction_moment" of supports; "energy" of the whole.
        x : str
            Along the axis of x: "t", or a scalar quantity of the same items.
        plane : str
            Two or three letters of "xyz": the points' paths in this plane, or in space.
        size : (float, float), mm
            Width and height; default by the number of panels.

        Returns
        -------
        Picture
            Shows in a notebook; ``.save("x.png")``, ``.figure``.

        Raises
        ------
        ModelError
            A name, quantity or plane is wrong, nothing was stored, or matplotlib is missing.
        """
        from ..viz.pictures.plot import plot

        return plot(self, what, quantity=quantity, x=x, plane=plane, size=size)

    def to_pandas(self, items: Any = None, *more: Any) -> Any:
        """Histories as a table: a DataFrame over the time, with units in the names and in ``attrs["units"]``.

        Parameters
        ----------
        items, *more : optional
            Points, springs, joints, contacts and supports, as objects of the model or by name, and "energy":
            one, several, or a list. Default of sensors all that they recorded; of a result start, middle and
            end of its bodies, springs, joints and energies.

        Returns
        -------
        pandas.DataFrame

        Raises
        ------
        ModelError
            There is no such item, or pandas is missing.
        """
        from ..viz.export.frames import to_pandas

        return to_pandas(self, [items, *more] if more else items)

    def to_xarray(self, items: Any = None, *more: Any) -> Any:
        """Histories as arrays with names: a Dataset over time, points and axes, units as attributes.

        ``position`` and ``velocity`` have the dimensions (t, point, axis), ``tension`` and ``curvature`` (t,
        point), not a number at points without, ``spring_force`` and ``spring_length`` (t, spring); joints,
        contacts and energies a variable for each number.

        Parameters
        ----------
        items, *more : optional
            As of :meth:`to_pandas`.

        Returns
        -------
        xarray.Dataset

        Raises
        ------
        ModelError
            There is no such item, or xarray is missing.
        """
        from ..viz.export.frames import to_xarray

        return to_xarray(self, [items, *more] if more else items)


class Filmed(Plotted):
    """What moves: a Result."""

    def to_csv(self, folder: str | Path, points: Sequence[Any] | None = None) -> list[Path]:
        """Write tables with names and units in the first row: the files of ``ancf export --to csv``.

        Parameters
        ----------
        folder : path
            Made when it does not exist.
        points : sequence of Point or str, optional
            Points of ``points.csv``. Without them, and without sensors: start, middle and end of the first
            beams, and the first masses.

        Returns
        -------
        list of Path
            The files written.

        Raises
        ------
        ModelError
            There is no such point, nothing was stored, or a file cannot be written.
        """
        from ..viz.export import write_csv

        return write_csv(self, checks.path(folder, "result.to_csv.folder"), _labels(points))  # type: ignore[arg-type]

    def to_excel(self, path: str | Path, points: Sequence[Any] | None = None) -> Path:
        """Write the same tables as the sheets of one workbook, ``.xlsx``, as ``ancf export --to xlsx`` does.

        Its first sheet names the run, and of every column its unit and what it is.

        Parameters
        ----------
        path : path
        points : sequence of Point or str, optional
            As of :meth:`to_csv`.

        Raises
        ------
        ModelError
            As of :meth:`to_csv`; openpyxl is missing, or a table has more rows than a sheet.
        """
        from ..viz.export import write_xlsx

        return write_xlsx(self, checks.path(path, "result.to_excel.path"), _labels(points))  # type: ignore[arg-type]

    def view(self, *, height: int = 600, **options: Any) -> Framed:
        """The page of ``ancf view``: the moving model with its plots.

        Parameters
        ----------
        height : int
            Of its frame in a notebook, pixels.
        options
            ``frames``, ``color``, ``trace``, ``start``, ``end``, ``title``: :func:`ancf.viz.view.shown_of`.

        Returns
        -------
        Framed
            Shows in a notebook; ``.save("view.html")``.

        Raises
        ------
        ModelError
            An option is wrong, nothing was stored, or plotly is missing.
        """
        from ..viz.view.frame import Framed

        return Framed(self, height, **options)

    def plot_shape(
        self,
        times: int | Sequence[float] = 5,
        *,
        plane: str | None = None,
        color: str = "t",
        size: tuple[float, float] | None = None,
    ) -> Picture:
        """Draw the shape of the model at some times in one picture.

        Parameters
        ----------
        times : int or sequence of float, s
            So many stored times, evenly spaced, or the stored times nearest to these.
        plane : str
            Two or three letters of "xyz": seen in this plane, or in space; default as the model moves.
        color : "t", "tension", "curvature", "speed" or "plain"
            What the bodies are coloured by.
        size : (float, float), mm
            Width and height; default by what is drawn.

        Raises
        ------
        ModelError
            A time, plane or colour is wrong, nothing was stored, or matplotlib is missing.
        """
        from ..viz.pictures.shape import plot_shapes

        return plot_shapes(self, times, plane=plane, color=color, size=size)

    def animate(
        self,
        color: str = "tension",
        *,
        trace: Sequence[Any] = (),
        frames: int = 240,
        start: float | None = None,
        end: float | None = None,
    ) -> Animation:
        """Moving picture: shows in a notebook; ``.save("x.html")``, ``.save("x.mp4")``, ``.save("x.gif")``.

        Parameters
        ----------
        color : "tension", "curvature", "speed" or "plain"
            What the bodies are coloured by.
        trace : sequence of points
            Whose paths are drawn.
        frames : int
            Stored states that are shown, at most.
        start, end : float, s
            Part of the run; default all.

        Raises
        ------
        ModelError
            There is no such colour or point; later, when a part is missing that draws or saves.
        """
        from ..viz.pictures.animation import animate

        return animate(self, color, trace=trace, frames=frames, start=start, end=end)


class StatePlotted:
    """What has a shape: a State."""

    def plot(
        self, *, plane: str | None = None, color: str = "tension", size: tuple[float, float] | None = None
    ) -> Picture:
        """Draw the shape of the model; see :meth:`ancf.Result.plot_shape`."""
        from ..viz.pictures.shape import plot_state

        return plot_state(self, plane=plane, color=color, size=size)


class ModesPlotted:
    """What has shapes that swing: Modes."""

    def plot(
        self, count: int = 4, *, plane: str | None = None, size: tuple[float, float] | None = None
    ) -> Picture:
        """Draw the lowest modes over the state they are about, each with its frequency.

        Parameters
        ----------
        count : int
            How many.
        plane : str
            Two or three letters of "xyz"; default for each mode the one in which it moves.
        size : (float, float), mm
            Width and height; default by the number of modes.

        Raises
        ------
        ModelError
            A count or plane is wrong, or matplotlib is missing.
        """
        from ..viz.pictures.shape import plot_modes

        return plot_modes(self, count, plane=plane, size=size)

    def animate(self, mode: int = 0, *, frames: int = 60) -> Animation:
        """Moving picture of a mode, counted from 0, over one period; see :meth:`ancf.Result.animate`."""
        from ..viz.pictures.animation import animate

        return animate(self, "plain", frames=frames, mode=mode)
