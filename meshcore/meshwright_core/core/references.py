# mypy: disable-error-code="attr-defined,name-defined"
"""Passes NamedTuples of arrays between kernels as one pointer.

Numba passes a NamedTuple by value: each member of each array struct becomes an LLVM argument, 73
for a mesh. At a thousand call sites this is half of the code that a cold start compiles. An
instance of a class decorated with :func:`by_reference` is a pointer to a read-only struct instead.
"""

from __future__ import annotations

from typing import Any, TypeVar

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.datamodel.models import OpaqueModel, PrimitiveModel
from numba.core.imputils import impl_ret_borrowed
from numba.core.registry import cpu_target
from numba.core.typing.templates import (
    AttributeTemplate,
    infer_getattr,
    make_callable_template,
)
from numba.core.utils import pysignature
from numba.extending import (
    NativeValue,
    lower_builtin,
    lower_getattr_generic,
    register_model,
    typeof_impl,
    unbox,
)

T = TypeVar("T", bound=type)

_WORD = 8
"""Bytes of a word; no field needs a stricter alignment."""
_ATTRIBUTES = ("noalias", "captures(none)", "nocapture")
"""What LLVM may assume of such an argument; the last two are one attribute by version of LLVM."""


class Referenced(types.NamedTuple):
    """Numba's type of an instance of a class that is marked :func:`by_reference`."""

    def can_convert_to(self, typingctx: Any, other: Any) -> None:
        """No implicit conversion to any other type."""
        return None


@register_model(Referenced)
class _ReferencedModel(PrimitiveModel):
    """A pointer to the fields, each at the start of a word; returned as the words themselves."""

    def __init__(self, dmm: Any, fe_type: Referenced) -> None:
        target = cpu_target.target_context.codegen().target_data
        self.fields = [dmm[field].get_value_type() for field in fe_type.types]
        words = [-(-field.get_abi_size(target) // _WORD) for field in self.fields]
        self.offsets = [_WORD * sum(words[:i]) for i in range(len(words))]
        self.struct = ir.ArrayType(ir.IntType(8 * _WORD), sum(words))
        pointer = self.struct.as_pointer()
        pointer.is_reference = True
        super().__init__(dmm, fe_type, pointer)

    def place(self, builder: Any, pointer: Any, index: int) -> Any:
        """The pointer to a field."""
        offset = ir.Constant(ir.IntType(32), self.offsets[index])
        start = builder.bitcast(pointer, ir.IntType(8).as_pointer())
        field = builder.gep(start, [offset], inbounds=True)
        return builder.bitcast(field, self.fields[index].as_pointer())

    def get_return_type(self) -> Any:
        return self.struct

    def as_return(self, builder: Any, value: Any) -> Any:
        return builder.load(value)

    def from_return(self, builder: Any, value: Any) -> Any:
        return cgutils.alloca_once_value(builder, value)


@lower_getattr_generic(Referenced)
def _field(context: Any, builder: Any, typ: Referenced, value: Any, attribute: str) -> Any:
    model = context.data_model_manager[typ]
    index = typ.fields.index(attribute)
    field = builder.load(model.place(builder, value, index))
    return impl_ret_borrowed(context, builder, typ.types[index], field)


@unbox(Referenced)
def _unbox(typ: Referenced, obj: Any, c: Any) -> NativeValue:
    """Of a tuple of the right class, which the type says, and so of the right length."""
    model = c.context.data_model_manager[typ]
    place = cgutils.alloca_once(c.builder, model.struct)
    failed = cgutils.false_bit
    cleanups = []
    held = []
    for i, kind in enumerate(typ.types):
        field = c.unbox(kind, c.pyapi.tuple_getitem(obj, i))
        c.builder.store(field.value, model.place(c.builder, place, i))
        failed = c.builder.or_(failed, field.is_error)
        if field.cleanup is not None:
            cleanups.append(field.cleanup)
        held.append((kind, field.value))

    def clean_up() -> None:
        for cleanup in reversed(cleanups):
            cleanup()
        # numba releases what an argument holds by its data model, which is only a pointer here
        if c.context.enable_nrt:
            for kind, value in held:
                c.context.nrt.decref(c.builder, kind, value)

    return NativeValue(place, is_error=failed, cleanup=clean_up)


class _Maker(types.NamedTupleClass):
    """Numba's type of a class that is marked :func:`by_reference`."""


register_model(_Maker)(OpaqueModel)


_referenced: set[type] = set()
_usual_type_of_class = typeof_impl.dispatch(type)


@typeof_impl.register(type)
def _type_of_class(value: type, c: Any) -> Any:
    return _Maker(value) if value in _referenced else _usual_type_of_class(value, c)


@infer_getattr
class _MakerAttributes(AttributeTemplate):
    key = _Maker

    def resolve___call__(self, maker: _Maker) -> Any:
        cls: Any = maker.instance_class
        signature = pysignature(cls)

        def typer(*args: Any, **kws: Any) -> Referenced:
            bound = signature.bind(*args, **kws)
            return Referenced([types.unliteral(field) for field in bound.args], cls)

        vars(typer)["pysig"] = signature
        return types.Function(make_callable_template(self.key, typer))


@lower_builtin(_Maker, types.VarArg(types.Any))
def _make(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    model = context.data_model_manager[sig.return_type]
    place = cgutils.alloca_once(builder, model.struct)
    for i, value in enumerate(args):
        builder.store(value, model.place(builder, place, i))
    return place


def by_reference(cls: T) -> T:
    """Class decorator: pass instances of this NamedTuple between kernels as a pointer.

    Kernels may read the fields by name and make instances, but not count on two instances made by
    one line of a function, in a loop for example, to be alive at the same time. An instance does
    not own its arrays: what a kernel allocates must outlive it by another name.
    """

    @typeof_impl.register(cls)
    def _typeof(value: Any, c: Any) -> Referenced:
        return Referenced([typeof_impl(field, c) for field in value], cls)

    _referenced.add(cls)
    return cls


def declare_read_only(module: ir.Module) -> None:
    """Add LLVM attributes: no function of the module writes through, or keeps, such pointers."""
    for function in module.functions:
        for argument in function.args:
            if getattr(argument.type, "is_reference", False):
                for attribute in _ATTRIBUTES:
                    if attribute in argument.attributes._known:
                        argument.add_attribute(attribute)
