"""From a hull to a ship moving in a seaway.

``import ogilvie as og`` gives the public names below. They are loaded when first used, so the import is quick and has no
side effects. Conventions: x forward, y port, z up; x(t) = Re X exp(+i omega t); SI and radians.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

_PUBLIC = {
    "Autopilot": "loads.control.autopilot",
    "CatenaryMooring": "loads.mooring_lines",
    "ConventionError": "errors",
    "ConvergenceError": "errors",
    "Convolution": "loads.radiation",
    "CrossFlowDrag": "loads.cross_flow",
    "Current": "loads.current",
    "DoubleCountingError": "errors",
    "DynamicPositioning": "loads.control.positioning",
    "ExcitationKernel": "memory.excitation_kernel",
    "ForceTable": "loads.force_table",
    "FormatError": "errors",
    "GZRestoring": "loads.gz",
    "HullLift": "loads.hull_lift",
    "HullRestoring": "loads.hull_restoring",
    "IkedaHull": "loads.ikeda",
    "IkedaRollDamping": "loads.ikeda_damping",
    "InputError": "errors",
    "LinearDamping": "loads.viscous",
    "LinearMooring": "loads.mooring",
    "LinearRestoring": "loads.restoring",
    "MoorDyn": "loads.moordyn",
    "MooringLine": "loads.mooring_line",
    "MooringTable": "loads.mooring_table",
    "Nmea": "post.nmea",
    "NonlinearFroudeKrylov": "loads.froude_krylov",
    "OgilvieError": "errors",
    "OgilvieWarning": "errors",
    "PanelMesh": "mesh.panels",
    "PointDrag": "loads.point_drag",
    "QuadraticDamping": "loads.viscous",
    "Retardation": "memory.retardation",
    "RigidBody": "body",
    "RollDamping": "loads.roll_damping",
    "Rudder": "loads.control.rudder",
    "Sea": "waves.sea",
    "SlowDrift": "loads.slow_drift",
    "SpeedKeeping": "loads.control.speed",
    "SpeedTable": "loads.speed_table",
    "State": "sim.state",
    "StateSpace": "memory.statespace",
    "StateSpaceRadiation": "loads.radiation",
    "Stepper": "sim.stepper",
    "SumFrequency": "loads.sum_frequency",
    "SurgeResistance": "loads.resistance",
    "Thruster": "loads.control.thruster",
    "UdpSender": "post.broadcast",
    "UserForce": "loads.control.user",
    "Vessel": "sim.vessel",
    "WaveDriftDamping": "loads.wave_drift_damping",
    "WaveExcitation": "loads.excitation",
    "WaveFilter": "loads.control.observer",
    "Wind": "waves.wind",
    "WindCoefficients": "loads.wind_coefficients",
    "WindForce": "loads.wind",
    "api_gust": "waves.gust",
    "at_speed": "hydro.at_speed",
    "bichromatic": "waves.sea",
    "blendermann_wind": "loads.wind_blendermann",
    "blowing_from": "waves.wind",
    "bretschneider": "waves.spectra",
    "check": "hydro.checks",
    "check_mesh": "mesh.inspect",
    "convolve": "memory.convolve",
    "davenport_gust": "waves.gust",
    "decay": "post.decay",
    "difference_qtf": "hydro.drift_qtf",
    "drift_about_body": "hydro.drift_origin",
    "equilibrium": "mesh.equilibrium",
    "excitation_kernel": "memory.excitation_kernel",
    "filled_qtf": "hydro.qtf",
    "gz_curve": "mesh.gz",
    "harris_gust": "waves.gust",
    "heal": "mesh.inspect",
    "hybrid_bem": "bem.hybrid",
    "hybrid_hydro": "bem.hybrid_hydro",
    "hydro_from_arrays": "hydro.schema",
    "hydrostatics": "mesh.hydrostatics",
    "identify": "memory.identify",
    "irregular": "waves.sea",
    "isherwood_wind": "loads.wind_isherwood",
    "jonswap": "waves.spectra",
    "joined_drift": "hydro.drift_join",
    "kernel_at_speed": "memory.kernel_at_speed",
    "load_mesh": "mesh.files",
    "mean_drift": "hydro.drift",
    "newman": "loads.newman_qtf",
    "npd_gust": "waves.gust",
    "ochi_hubble": "waves.spectra",
    "pierson_moskowitz": "waves.spectra",
    "plot": "post.plot:",
    "rao": "hydro.rao",
    "read_hydro": "hydro.files",
    "regular": "waves.sea",
    "response_spectrum": "hydro.response",
    "response_statistics": "hydro.response",
    "retardation": "memory.retardation",
    "run_real_time": "sim.real_time",
    "sea_from_record": "waves.sea",
    "shapes": "mesh.shapes:",
    "short_wave_drift": "hydro.drift_short",
    "simulate": "sim.simulate",
    "slow_drift_force": "loads.slow_drift",
    "solve_bem": "hydro.capytaine",
    "spectrum_from_table": "waves.spectra",
    "spreading": "waves.spectra",
    "stats": "post.stats:",
    "torsethaugen": "waves.spectra",
    "transient_green": "bem.transient_green",
    "units": "units:",
    "wave_roll_damping": "loads.ikeda_wave",
    "with_qtf": "hydro.qtf",
    "with_raised_sides": "mesh.raise_sides",
    "write_mesh": "mesh.files",
    "write_wamit": "hydro.wamit_write",
    "zero_speed_equivalent": "hydro.at_speed",
}

__all__ = sorted([*_PUBLIC, "__version__"])


def __getattr__(name: str) -> Any:
    """Load a public name on first use (a trailing ':' in the table marks a module)."""
    try:
        where = _PUBLIC[name]
    except KeyError:
        raise AttributeError(
            f"module 'ogilvie' has no attribute {name!r}; public names: {', '.join(sorted(_PUBLIC))}"
        ) from None
    module = import_module(f"ogilvie.{where.rstrip(':')}")
    value = module if where.endswith(":") else getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__


if TYPE_CHECKING:
    from ogilvie.body import RigidBody
