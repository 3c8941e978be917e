"""Code that a render of frames runs inside Blender, as arguments of its command line.

Blender writes a picture directly into its file, skips a file that is there, whole or not, and ends with exit code 0 if it could
not write a picture, or only a part of it on a full disk. With this code a file gets its name when it is whole, an empty one is
rendered again, and the exit code is 1 unless all files are there. Blender runs its arguments in their order: PREPARE behind -o
and before -f, CHECK behind -f. Without a shell or a file beside the job, this works on every system.
"""

import json

_PREPARE = """\
def prepare():
    import bpy, os, sys, uuid
    render = bpy.context.scene.render
    pattern = render.filepath
    folder, name = os.path.split(pattern)
    part = os.path.join(folder, ".part-" + uuid.uuid4().hex[:8] + "-" + name)
    frames = []
    for piece in sys.argv[sys.argv.index("-f") + 1].split(","):
        first, _, last = piece.partition("..")
        frames += range(int(first), int(last or first) + 1)
    files = [render.frame_path(frame=frame) for frame in frames]
    if render.is_movie_format or os.path.splitext(files[0])[1] != os.path.splitext(pattern)[1]:
        print("The job expects", pattern, "and the scene's file format makes", files[0], file=sys.stderr)
        sys.exit(2)

    def begin(scene, *_):
        render.filepath = part

    def end(scene, *_):
        made, render.filepath = render.frame_path(frame=scene.frame_current), pattern
        file = render.frame_path(frame=scene.frame_current)
        # A disk that has no room now was full before the end of the picture, too.
        try:
            with open(made + ".room", "wb") as room:
                room.write(bytes(1 << 20))
                room.flush()
                os.fsync(room.fileno())
        finally:
            os.remove(made + ".room")
        os.replace(made, file)
        print("Saved:", repr(file), flush=True)

    def check():
        missing = [file for file in files if not os.path.exists(file)]
        if missing:
            print("Not rendered:", *missing, file=sys.stderr)
            sys.exit(1)

    for file in files:
        if os.path.exists(file) and not os.path.getsize(file):
            os.remove(file)
    render.use_overwrite = render.use_placeholder = False
    bpy.app.handlers.render_pre.append(begin)
    bpy.app.handlers.render_write.append(end)
    bpy.app.driver_namespace["lancer_check"] = check
prepare()
"""

# One line, as OpenJD takes no others. The code has neither braces, in which farms replace names, nor the quotes of shells.
PREPARE = f"exec({json.dumps(_PREPARE)})"
CHECK = 'import bpy; bpy.app.driver_namespace["lancer_check"]()'

# Arguments of Blender that a job sets itself, or that would change the meaning of those behind them.
TAKEN = frozenset(
    "-- -b --background -E --engine -o --render-output -x --use-extension -f --render-frame -a --render-anim "
    "-s --frame-start -e --frame-end --python-exit-code".split()
)
