"""The engines available here; without wasmtime there is no WebAssembly engine."""

from aseba_vm.jit.tiering import AUTO, ENGINES, INTERPRETER, WASM
from aseba_vm.jit.wasm_backend import is_available

AVAILABLE = [name for name in ENGINES if name != WASM or is_available()]
TRANSLATORS = [name for name in AVAILABLE if name not in (AUTO, INTERPRETER)]
