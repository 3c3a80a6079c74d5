"""The engines available here; without wasmtime there is no WebAssembly engine."""

from aseba_vm.jit.tiering import AUTO, ENGINES, INTERPRETER, WASM
from aseba_vm.kernel.wasm_runtime import is_usable

AVAILABLE = [name for name in ENGINES if name != WASM or is_usable()]
TRANSLATORS = [name for name in AVAILABLE if name not in (AUTO, INTERPRETER)]
