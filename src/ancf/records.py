"""Records: batches as compiled code holds them, at an address."""

from __future__ import annotations

from typing import Any

from numba import types
from numba.core.datamodel import models
from numba.extending import intrinsic, register_model

from .compiled import kernel


class RecordType(types.Type):
    """Type in kernels of the address of a batch of a type."""

    def __init__(self, batch: Any) -> None:
        self.batch = batch
        super().__init__(name=f"Record({batch})")


register_model(RecordType)(models.OpaqueModel)


@intrinsic
def write(typing, batch, words):
    """Write a batch as a record into an array of words."""

    def generate(context, builder, signature, arguments):
        place = context.make_array(signature.args[1])(context, builder, arguments[1]).data
        place = builder.bitcast(place, context.get_data_type(batch).as_pointer())
        context.pack_value(builder, batch, arguments[0], place)
        return context.get_dummy_value()

    return types.none(batch, words), generate


@intrinsic
def read(typing, record):
    """The batch at an address."""

    def generate(context, builder, signature, arguments):
        place = builder.bitcast(arguments[0], context.get_data_type(record.batch).as_pointer())
        return context.unpack_value(builder, record.batch, place)

    return record.batch(record), generate


@kernel
def keep(batch, words):
    """See :func:`write`."""
    write(batch, words)
