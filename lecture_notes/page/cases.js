// What each page runs and shows.
//   runs      program, case and parameters; the last ones say how often there is a picture
//   picture   kind of file that the program would write, and how it is drawn (pictures.js)
//   chart     columns of the history over its column x; relative: over their first value
//   sliders   parameter, from, to, and of which run if not of all
//   chapter, step   of the lecture notes, and of the code
const cases = {
    two_stream: {
        title: "Two streams (clouds-in-cells)",
        words: "Two cold electron beams pass through each other. The field grows as theory says, until it traps particles: the beams roll up into vortices in phase space.",
        runs: [{program: "cic", args: ["cic/cases/two_stream.toml", "output.particles_interval=0.2"]}],
        picture: {kind: "particles", draw: "points", x: "x", y: "v_x", color: "species", y_low: -3.5, y_high: 3.5},
        chart: {x: "time", log: true, lines: ["field", "kinetic"]},
        sliders: [["species.right.drift_x", 0.2, 2], ["species.left.drift_x", -2, -0.2], ["species.right.amplitude", 0, 0.1], ["time.dt", 0.01, 0.4], ["time.end", 20, 200]],
        chapter: "01_clouds_in_cells.md", step: "cic/step.hpp"
    },
    landau: {
        title: "Landau damping (clouds-in-cells)",
        words: "A wave in a warm plasma is damped without collisions: particles near its phase velocity take its energy. Color is the density in phase space less its mean over x.",
        runs: [{program: "cic", args: ["cic/cases/landau.toml", "species.electrons.particles_per_cell=4096", "output.phase_interval=0.1", "output.phase_v_max=4", "output.phase_bins_x=32", "output.phase_bins_v=64"]}],
        picture: {kind: "phase", draw: "image", value: "f_electrons", palette: "diverging", less_mean: true},
        chart: {x: "time", log: true, lines: ["field"]},
        sliders: [["species.electrons.amplitude", 0.001, 0.5], ["species.electrons.temperature_x", 0.2, 2], ["time.dt", 0.01, 0.4], ["time.end", 10, 100]],
        chapter: "01_clouds_in_cells.md", step: "cic/step.hpp"
    },
    finite_grid: {
        title: "Heating by a finite grid (clouds-in-cells)",
        words: "A cold beam drifts through its own mesh, alone: nothing physical can happen. Aliases of its waves resonate, and it heats until it is warm enough not to notice the mesh.",
        runs: [{program: "cic", args: ["cic/cases/cold_beam_grid_instability.toml", "output.particles_interval=0.4"]}],
        picture: {kind: "particles", draw: "points", x: "x", y: "v_x", color: "species", y_low: -0.6, y_high: 0.8},
        chart: {x: "time", log: true, lines: ["kinetic", "field"]},
        sliders: [["species.beam.drift_x", 0.02, 1], ["grid.cells_x", 48, 256], ["species.beam.amplitude", 0.00001, 0.01], ["time.end", 50, 400]],
        chapter: "01_clouds_in_cells.md", step: "cic/step.hpp"
    },
    sod: {
        title: "A shock tube (pic and FLIP)",
        words: "Two gases at rest, one at eight times the density of the other: a shock runs to the right, a rarefaction to the left, a contact between them. Classical pic beside FLIP.",
        runs: [{program: "pic", args: ["flip/cases/sod.toml", "output.fields_interval=1e-5"]}, {program: "flip", args: ["flip/cases/sod.toml", "output.fields_interval=1e-5"]}],
        picture: {kind: "fields", draw: "lines", values: ["rho", "v_x", "p"], y_low: 0, y_high: 1.1},
        chart: {x: "time", lines: ["kinetic"]},
        sliders: [["left.pressure", 0.2, 5], ["right.density", 0.05, 1], ["grid.cells_x", 25, 400], ["particles.per_cell_x", 2, 32]],
        chapter: "03_flip.md", step: "flip/pic/step.hpp flip/flip/step.hpp"
    },
    rayleigh_taylor: {
        title: "Heavy above light fluid (pic and FLIP)",
        words: "Gravity turns the fluids over. Spikes fall, bubbles rise, and shear rolls up their flanks. pic does not feel what is slow: its start is faster, too fast for the theory of small waves.",
        runs: [{program: "pic", args: ["flip/cases/rayleigh_taylor.toml", "region.lower.amplitude=0.2", "region.upper.amplitude=0.2", "theory.compare=none", "grid.cells_x=32", "grid.cells_z=64", "output.particles_interval=0.01"]},
            {program: "flip", args: ["flip/cases/rayleigh_taylor.toml", "grid.cells_x=32", "grid.cells_z=64", "output.particles_interval=0.01"]}],
        picture: {kind: "particles", draw: "points", x: "x", y: "z", color: "material", equal: true},
        chart: {x: "time", log: true, lines: ["kinetic"]},
        sliders: [["region.upper.density", 1.1, 4], ["gravity.z", -3, -0.2], ["region.upper.amplitude", 0.01, 0.4, 1], ["grid.cells_x", 16, 64], ["grid.cells_z", 32, 128]],
        chapter: "03_flip.md", step: "flip/pic/step.hpp flip/flip/step.hpp"
    },
    rebound: {
        title: "A rebound (explicit and implicit material point method)",
        words: "Two elastic disks collide and rebound. Raise alpha, the time step over that of sound across a cell: the explicit method gains energy and bursts, the implicit one keeps it.",
        runs: [{program: "mpm_explicit", args: ["mpm_explicit/cases/rebound.toml", "output.particles_interval=0.006"]}, {program: "mpm_implicit", args: ["mpm_implicit/cases/rebound.toml", "output.particles_interval=0.006"]}],
        picture: {kind: "particles", draw: "points", x: "x", y: "y", color: "grain", equal: true},
        chart: {x: "time", lines: ["energy"], relative: true, y_low: 0.9, y_high: 1.1},
        sliders: [["time.alpha", 0.05, 2, 0], ["time.alpha", 0.25, 8, 1], ["method.theta", 0.5, 1, 1], ["grain.left.velocity_x", 0.02, 0.3], ["material.default.nu", 0, 0.45]],
        chapter: "04b_implicit_mpm.md", step: "mpm_explicit/step.hpp mpm_implicit/step.hpp"
    },
    compressed: {
        title: "Compressed grains in polarized light (material point method)",
        words: "Eighteen disks in a box, pressed by a plate. Between crossed polarizers every dark line joins points of equal difference of the principal stresses, 0.03 E from one line to the next.",
        runs: [{program: "mpm_explicit", args: ["mpm_explicit/cases/compressed.toml", "method.shape=gimp", "output.fringes_interval=0", "output.particles_interval=0.001"]}],
        picture: {kind: "particles", draw: "points", x: "x", y: "y", color: "fringes", equal: true},
        chart: {x: "time", lines: ["energy", "elastic", "kinetic"]},
        sliders: [["grain.plate.velocity_y", -0.3, -0.02], ["material.default.E", 2e4, 5e5], ["material.default.nu", 0, 0.45], ["time.alpha", 0.05, 0.5], ["time.end", 0.1, 0.4]],
        chapter: "04a_explicit_mpm.md", step: "mpm_explicit/step.hpp"
    },
    gem: {
        title: "GEM reconnection (implicit moment method)",
        words: "The current sheet of the GEM challenge thins and reconnects. Color is the out-of-plane current, lines are field lines; below, the reconnected flux.",
        runs: [{program: "implicit_moment", args: ["implicit_moment/cases/gem.toml", "output.fields_interval=0.3"]}],
        picture: {kind: "fields", draw: "image", value: "J_y", contours: "A_y", palette: "inferno", equal: true, from_zero: true},
        chart: {x: "time_Omega_ci", lines: ["flux"]},
        sliders: [["harris.mass_ratio", 1, 100], ["harris.particles", 2e4, 4e5], ["harris.perturbation", 0, 0.3], ["harris.thickness", 0.3, 1], ["field.theta", 0.5, 1], ["time.end", 100, 800]],
        chapter: "06_reconnection_and_current_sheets.md", step: "implicit_moment/step.hpp"
    }
};
