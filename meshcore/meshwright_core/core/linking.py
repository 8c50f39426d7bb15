# mypy: disable-error-code="attr-defined,name-defined"
"""Compiles and links numba kernels so that a cold start compiles each of them once.

For every function that a kernel calls, numba generates a library with machine code and a wrapper
for Python, and optimises its LLVM IR again in each caller. Here a kernel has one of three forms:

part
    A kernel called by another kernel: type inference and unoptimised LLVM IR only. Its argument
    types are canonical (see :func:`canonical`), so that one part serves int32 and int64.
entry point
    A kernel called from Python: all parts in its call graph are linked into one LLVM module with
    internal linkage, optimised once, and cached on disk as machine code.
shared kernel
    An entry point that other kernels call through an external symbol. Their cached machine code
    contains only the name of the symbol, so the shared kernel is loaded before they are.
"""

from __future__ import annotations

import copy
import gc
import hashlib
import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

import llvmlite.binding as llvm
from numba.core import compiler, types, typing
from numba.core import config as numba_config
from numba.core.caching import CompileResultCacheImpl, FunctionCache, UserProvidedCacheLocator
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import compile_result
from numba.core.compiler_lock import global_compiler_lock
from numba.core.environment import lookup_environment
from numba.core.registry import CPUDispatcher
from numba.core.runtime import rtsys

from meshwright_core.core.interrupts import interrupts_held
from meshwright_core.core.references import declare_read_only

Types = tuple[Any, ...]
"""Numba types of arguments."""

_log = logging.getLogger(__name__)

_SYMBOL = "meshwright."
_ENVIRONMENT = "_ZN08NumbaEnv"

_shared: dict[str, tuple[str, str, Types]] = {}
"""Module, name and argument types of shared kernels, by the symbol of their machine code."""


def canonical(kind: Any) -> Any:
    """The argument type under which a kernel is compiled for calls from other kernels.

    int64 for every integer type that fits into it, literals included; other types are unchanged.
    """
    kind = types.unliteral(kind)
    if isinstance(kind, types.Integer) and (kind.signed or kind.bitwidth < 64):
        return types.int64
    return kind


class Part(JITCodeLibrary):
    """The unoptimised LLVM IR of one kernel, with references to the libraries that it calls."""

    def add_ir_module(self, ir_module: Any) -> None:
        """Add code to this library."""
        declare_read_only(ir_module)
        super().add_ir_module(ir_module)

    def finalize(self) -> None:
        """Do nothing: an entry point links and optimises the IR of all its parts together."""
        self._finalized = True

    def reached(self, found: dict[Any, None]) -> None:
        """Add this library and all that it calls, directly or not, to ``found``."""
        if self in found:
            return
        found[self] = None
        for library in self._linking_libraries:
            if isinstance(library, Part):
                library.reached(found)
            else:
                found[library] = None


class EntryPoint(JITCodeLibrary):
    """Optimised machine code of one kernel with everything that it calls."""

    exported: frozenset[str] = frozenset()
    """Names of the functions that keep external linkage."""

    def finalize(self) -> None:
        """Link all parts, optimise them together, and make machine code."""
        self._codegen._check_llvm_bugs()
        self._raise_if_finalized()
        found: dict[Any, None] = {}
        for library in self._linking_libraries:
            if isinstance(library, Part):
                library.reached(found)
            else:
                found[library] = None
        runtime = found.pop(rtsys.library, 0) is None
        for library in found:
            if isinstance(library, Part):
                self._final_module.link_in(library._final_module, preserve=True)
            else:
                self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        if runtime and self._counts_references():
            self._final_module.link_in(rtsys.library._get_module_for_linking(), preserve=True)
        for function in self._final_module.functions:
            if not function.is_declaration and function.name not in self.exported:
                function.linkage = "internal"
        self._optimize_final_module()
        self._final_module.verify()
        self._finalize_final_module()

    def _counts_references(self) -> bool:
        return any(
            function.is_declaration and function.name.startswith("NRT_")
            for function in self._final_module.functions
        )

    def needed(self) -> list[tuple[str, str, Types]]:
        """The shared kernels that the code calls: module, name, argument types."""
        return [
            _shared[function.name]
            for function in self._final_module.functions
            if function.is_declaration and function.name in _shared
        ]

    def environments(self) -> list[Any]:
        """The environments (constants of raised exceptions) that the code refers to."""
        names = [variable.name for variable in self._final_module.global_variables]
        found = [lookup_environment(name) for name in names if name.startswith(_ENVIRONMENT)]
        return [environment for environment in found if environment is not None]

    def machine_code(self) -> tuple[str, bytes, list[str]]:
        """Name, object file, and the names that it defines."""
        module = self._final_module
        defined = [
            value.name
            for values in (module.functions, module.global_variables)
            for value in values
            if not value.is_declaration
        ]
        return self.name, self._get_compiled_object(), defined

    @classmethod
    def load(cls, codegen: Any, name: str, code: bytes, defined: list[str]) -> EntryPoint:
        """Rebuild a library from what :meth:`machine_code` returned."""
        library = cls(codegen, name)
        library.enable_object_caching()
        library._set_compiled_object(code)
        library._finalize_final_module()
        codegen._engine._defined_symbols.update(defined)
        return library


class _ByModule(UserProvidedCacheLocator):
    """Finds the files of a kernel by the name of its package, not by where that is installed.

    The cache folder belongs to these very sources, so all installations of them share it.
    """

    def __init__(self, py_func: Callable[..., Any], py_file: str) -> None:
        super().__init__(py_func, py_file)
        package = py_func.__module__.rpartition(".")[0]
        self._cache_path = str(Path(numba_config.CACHE_DIR) / package)


class _StoredForm(CompileResultCacheImpl):
    """Converts an entry point to what is pickled into the cache, and back."""

    # numba's other locators put files beside the sources or under a key that misses imported code
    _locator_classes = (_ByModule,)

    def reduce(self, result: Any) -> Any:
        library = result.library
        description = copy.copy(result.fndesc)
        description.typemap = description.calltypes = None
        environments = [each for each in library.environments() if each.can_cache()]
        return (
            library.machine_code(), library.needed(), description, result.environment,
            result.signature, environments,
        )  # fmt: skip

    def rebuild(self, target_context: Any, stored: Any) -> Any:
        code, needed, description, environment, signature, environments = stored
        for module, name, kinds in needed:
            getattr(import_module(module), name).provide(kinds)
        library = EntryPoint.load(target_context.codegen(), *code)
        entry = target_context.get_executable(library, description, environment)
        for each in environments:
            library.codegen.set_env(each.env_name, each)
        return compile_result(
            typing_context=target_context.typing_context,
            target_context=target_context,
            entry_point=entry,
            library=library,
            signature=signature,
            objectmode=False,
            lifted=(),
            fndesc=description,
            environment=environment,
            type_annotation="",
        )


@cache
def note_unwritable(folder: str, reason: str) -> None:
    """Log, once for each folder and reason, that compiled code is not kept."""
    _log.warning(
        "Compiled code cannot be kept in %s (%s): each start compiles again."
        " Set MESHWRIGHT_CACHE_DIR to a writable folder.",
        folder,
        reason,
    )


class KernelCache(FunctionCache):
    """Numba's cache of one function, with the entry points of a kernel in it."""

    _impl_class = _StoredForm

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The entry point for these argument types, or None.

        Numba's method first registers everything that can be called in kernels, which takes a
        quarter of a second; machine code needs the runtime for reference counts only.
        """
        rtsys.initialize(target_context)
        with self._guard_against_spurious_io_errors():
            try:
                return self._load_overload(sig, target_context)
            except Exception:  # a damaged file can fail in any way; the kernel is compiled again
                with suppress(OSError):
                    self.flush()
                return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Write an entry point to disk; a full disk only costs the next process a compilation."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            note_unwritable(self.cache_path, error.strerror or str(error))


class Kernel(CPUDispatcher):
    """A function that numba compiles as a part for kernels and as an entry point for Python."""

    def __init__(
        self, py_func: Callable[..., Any], locals: Any = None, targetoptions: Any = None,
        pipeline_class: Any = compiler.Compiler,
    ) -> None:  # fmt: skip
        super().__init__(py_func, locals or {}, targetoptions, pipeline_class)
        self._parts: dict[Types, Any] = {}
        self._keys: dict[Types, object] = {}

    def enable_caching(self) -> None:
        """Keep entry points on disk; RuntimeError or OSError if there is no folder for them."""
        self._cache = KernelCache(self.py_func)

    # Called by numba's type inference and code generation, for calls from other kernels

    def get_call_template(self, args: Any, kws: Any) -> tuple[Any, Any, Any, Any]:
        """A template of one signature, that of the part."""
        pysig, args = self._compiler.fold_argument_types(args, kws)
        signature = self._callable(tuple(canonical(kind) for kind in args))
        name = self.py_func.__name__
        template = typing.make_concrete_template(
            f"CallTemplate({name})", key=name, signatures=[signature]
        )
        return template, pysig, args, {}

    def get_overload(self, sig: Any) -> object:
        """The key under which the code generator finds how to call the part."""
        return self._keys[typing_of(sig)[0]]

    def _callable(self, args: Types) -> Any:
        """The signature under which kernels call this one with canonical arguments."""
        part = self._part(args)
        if args not in self._keys:
            self._keys[args] = object()
            self.targetctx.insert_user_function(self._keys[args], part.fndesc, [part.library])
        return part.signature

    def _part(self, args: Types) -> Any:
        part = self._parts.get(args)
        if part is None:
            flags = compiler.Flags()
            self.targetdescr.options.parse_as_flags(flags, self.targetoptions)
            flags.no_cpython_wrapper = flags.no_cfunc_wrapper = flags.no_compile = True
            part = compiler.compile_extra(
                self.typingctx, self.targetctx, self.py_func, args, None, flags, self.locals,
                Part(self.targetctx.codegen(), self.py_func.__qualname__), compiler.Compiler,
            )  # fmt: skip
            self._parts[args] = part
        return part

    # For calls from Python

    def compile(self, sig: Any) -> Any:
        """Compile an entry point for these arguments, or load it; returns what Python calls."""
        with global_compiler_lock, _collecting_seldom():
            args, _ = typing_of(sig)
            known = self.overloads.get(args)
            if known is None:
                with interrupts_held():
                    known = self._cache.load_overload(args, self.targetctx)
                if known is None:
                    self._cache_misses[args] += 1
                    part = self._part(args)  # takes longest, and may be interrupted
                    with interrupts_held():
                        known = self._linked(part)
                        self._cache.save_overload(args, known)
                else:
                    self._cache_hits[args] += 1
                self.targetctx.insert_user_function(known.entry_point, known.fndesc, [])
                self.add_overload(known)
            return known.entry_point

    def _linked(self, part: Any) -> Any:
        """The entry point of a part."""
        library = EntryPoint(self.targetctx.codegen(), self.py_func.__qualname__)
        library.enable_object_caching()
        description = part.fndesc
        library.exported = frozenset(
            (description.llvm_func_name, description.llvm_cpython_wrapper_name)
        )
        context = part.target_context.subtarget(environment=part.environment, fndesc=description)
        library.add_linking_library(part.library)
        with context.push_code_library(library):
            context.create_cpython_wrapper(
                library, description, part.environment, part.call_helper, release_gil=True
            )
        entry = context.get_executable(library, description, part.environment)
        for environment in library.environments():
            library.codegen.set_env(environment.env_name, environment)
        return compile_result(
            typing_context=part.typing_context,
            target_context=part.target_context,
            entry_point=entry,
            type_annotation="",
            library=library,
            signature=part.signature,
            objectmode=False,
            lifted=(),
            fndesc=description,
            environment=part.environment,
        )


class SharedKernel(Kernel):
    """A kernel whose code is linked into none of its callers: they call it by its symbol."""

    def _callable(self, args: Types) -> Any:
        symbol = self.provide(args)
        result = self.overloads[args]
        if args not in self._keys:
            description = copy.copy(result.fndesc)
            description.mangled_name = symbol
            self._keys[args] = object()
            self.targetctx.insert_user_function(self._keys[args], description, [])
        return result.signature

    def provide(self, args: Types) -> str:
        """Load or compile the machine code and register its symbol, which is returned."""
        module, name = self.py_func.__module__, self.py_func.__name__
        kinds = hashlib.sha256(str(args).encode()).hexdigest()[:16]
        symbol = f"{_SYMBOL}{module}.{name}.{kinds}"
        if symbol not in _shared:
            self.compile(args)
            result = self.overloads[args]
            address = result.library.get_pointer_to_function(result.fndesc.llvm_func_name)
            llvm.add_symbol(symbol, address)
            _shared[symbol] = module, name, args
        return symbol


@contextmanager
def _collecting_seldom() -> Iterator[None]:
    """Run Python's garbage collector less often: compiling creates many objects and few reference
    cycles, and collecting takes an eighth of the time.
    """
    usual = gc.get_threshold()
    if usual[0]:
        gc.set_threshold(max(usual[0], 100_000), *usual[1:])
    try:
        yield
    finally:
        gc.set_threshold(*usual)


def typing_of(sig: Any) -> tuple[Types, Any]:
    """Argument types, and the return type or None, of a signature or a tuple of types."""
    if isinstance(sig, tuple):
        return sig, None
    return tuple(sig.args), sig.return_type


def kernels(module: Any) -> Iterator[Kernel]:
    """The kernels that are defined in a module."""
    for value in vars(module).values():
        if isinstance(value, Kernel) and value.py_func.__module__ == module.__name__:
            yield value
