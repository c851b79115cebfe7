"""Supporting: the part of a Model that holds and moves nodes, and winches."""

from __future__ import annotations

from typing import Any, TypeVar

from ...errors import ModelError
from ..bodies.rigid import RigidBody
from ..functions.function import check_inputs, refuse_inputs
from ..joints.basic import Fixation
from ..joints.connecting import PointLike
from ..points import Point
from ..surroundings.adding import Surroundings
from .support import Clamp, Hold, Pin, Support, check_overlap, make_clamp, make_hold, optional, require_node
from .winch import Winch, make_winch

SupportT = TypeVar("SupportT", bound=Support)


class Supporting(Surroundings):
    """Supports and winches of one model."""

    def pin(self, point: PointLike, displacement: Any = None, name: str | None = None) -> Pin:
        """Hold a node, point mass or rigid body's centre, or move it by displacement(t) (3,) in m.

        The displacement is from the initial place; what is only pinned turns freely.
        """
        where, clean = self._at_node("pin", point, name)
        label = self._names.of_item(name, f"pin at {clean}", where)
        motion = optional(displacement, 3, f"{where}.displacement", "m")
        return self._add_support(where, Pin(label, clean, motion))

    def clamp(
        self,
        point: PointLike,
        stretch: str = "free",
        rotation: Any = None,
        axis: Any = (0, 0, 1),
        rotation_rate: Any = None,
        rotation_acceleration: Any = None,
        displacement: Any = None,
        name: str | None = None,
        to: RigidBody | str | None = None,
        rotation_vector: Any = None,
    ) -> Clamp | Fixation:
        """Hold position and slope of a node, on a beam all three slopes, or a rigid body, or move them.

        Parameters
        ----------
        point : Point or RigidBody
            At a node, or a rigid body, which is held altogether.
        stretch : "free" or "fixed"
            Hold the direction of r_x only, or all of it (the wall strain is then zero); on a beam of
            r_x, r_y and r_z.
        rotation : function of time, rad
            Angle of the slopes or the body about `axis`, from the initial ones.
        axis : (3,)
            Axis of the rotation; any length but zero.
        rotation_rate, rotation_acceleration : functions of time, rad/s, rad/s^2
            Exact derivatives, both or none.
        displacement : function of time, (3,) m
            From the initial position.
        name : str
            Default "clamp at beam.start".
        to : RigidBody
            Clamp the node to this body where it is, instead of holding or moving it.
        rotation_vector : function of time, (3,) rad
            Instead of `rotation`: the axis times the angle from the initial slopes, for what turns about
            axes that change, as a gripper does.

        """
        if to is not None:
            moving = {
                "rotation": rotation,
                "rotation_vector": rotation_vector,
                "rotation_rate": rotation_rate,
                "rotation_acceleration": rotation_acceleration,
                "displacement": displacement,
            }
            for key, given in moving.items():
                if given is not None:
                    where = f"{self._where('clamp', name, point)}.{key}"
                    raise ModelError(where, "has no effect with to: the node follows the body")
            return self._fix(point, to, stretch, name)
        where, clean = self._at_node("clamp", point, name)
        item = make_clamp(
            where,
            self._names.of_item(name, f"clamp at {clean}", where),
            clean,
            stretch=stretch,
            rotation=rotation,
            axis=axis,
            rotation_rate=rotation_rate,
            rotation_acceleration=rotation_acceleration,
            displacement=displacement,
            rotation_vector=rotation_vector,
        )
        return self._add_support(where, item)

    def hold(
        self,
        point: PointLike,
        position: str = "",
        slope: str = "",
        slope_y: str = "",
        slope_z: str = "",
        twist: bool = False,
        displacement: Any = None,
        name: str | None = None,
    ) -> Hold:
        """Keep single components of position and slopes of a node at their initial values, or move the first.

        Parameters
        ----------
        point : Point, PointMass or RigidBody
            At a node, or a point mass or a rigid body's centre, which have a position only.
        position, slope : str
            Letters of "xyz" of the position r and of the slope r_x, global directions.
        slope_y, slope_z : str
            The same of r_y and r_z, of beams only.
        twist : bool
            Hold the component of r_y along the initial local z axis: the section does not turn about
            the tangent and is free to bend. Of beams only, and not together with slope_y.
        displacement : function of time, (3,) m
            The components in `position` follow it from the initial place; those that are not held stay
            free, whatever it says of them.
        name : str
            Default "hold at beam.start".

        """
        where, clean = self._at_node("hold", point, name)
        label = self._names.of_item(name, f"hold at {clean}", where)
        letters = {"position": position, "slope": slope, "slope_y": slope_y, "slope_z": slope_z}
        item = make_hold(where, label, clean, **letters, twist=twist, displacement=displacement)
        return self._add_support(where, item)

    def winch(
        self,
        point: PointLike,
        length: Any,
        name: str | None = None,
        *,
        speed: Any = None,
        acceleration: float | None = None,
    ) -> Winch:
        """Pay out or haul in a cable at one of its ends.

        All elements share the change of the length; the other end keeps its material. The node at the winch
        is not held: pin it, or connect it to what carries the winch. `point.at(x)` of such a cable is the
        place at the fraction x/length of its present length, and nothing may be fastened between its ends.

        Parameters
        ----------
        point : Point
            Start or end of a cable that is naturally straight.
        length : function of time, m
            Natural length of what is paid out; it should start and stop smoothly. A constant is a length
            that differs from the one of ``add_beam``. An input, or a formula of inputs, is a length to which
            the winch goes as fast as `speed` and `acceleration` let it.
        name : str
            Default "winch at rope.start".
        speed : function of time, m/s, optional
            An input or a function of time: the winch pays out with this speed, from the number `length` on,
            and hauls in where it is negative. With a `length` of inputs: a number, the largest speed.
        acceleration : float, m/s^2
            The largest, with a `speed`: what the winch is told may jump, its speed does not.

        """
        where, clean = self._at_node("winch", point, name)
        label = self._names.of_item(name, f"winch at {clean}", where)
        item = make_winch(where, label, clean, length, speed, acceleration)
        return self._add_support(where, item)

    def _at_node(self, method: str, point: object, name: object) -> tuple[str, Point]:
        where = self._where(method, name, point)
        clean = self._point(point, f"{where}.point")
        require_node(clean, f"{where}.point")
        return where, clean

    def _add_support(self, where: str, item: SupportT) -> SupportT:
        check_overlap(where, item, self.supports)
        if isinstance(item, Winch):
            check_inputs(item, self.inputs)
        else:
            refuse_inputs(item)
        self._names.take(item.name, "support")
        self.supports.append(item)
        return item
