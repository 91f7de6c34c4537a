"""Writes the page of docs/results/measuring."""

HEAD = """# Lists of measured points: error against time

Made by `bench/measuring --copy docs/results/measuring`, this page too; nothing here is typed by
hand. Points are what a picture shows, on floors, walls and furniture alike: every pixel of a coarse
one (the long list), or some of them. `troffer measure` as it is (`--error 0.01`, which measures to a
quarter of it) beside `--method path`, in one run on the same machine. *Processor s*: of the whole
command, all threads, reading the scene and all preparation included. *Standard error*: as it is told,
root mean square over the list's mean. *Inside*: of 95 % intervals, those that hold what other paths
have found (131 072 at points of the short list, 32 768 of the long one), both errors together; *z*:
root mean square of the differences over these errors, 1 where errors are honest. *In all*: the list's
mean against that of these paths, whose own standard errors are in the table `measuring.csv`. *Path, s
at equal error*: path tracing's error falls with the root of its time. *Each point*: the same with
each point's error over its own light, root mean square, which is what `--error` asks for: points in
the dark then count as much as bright ones, and paths, of which all get as many, are the dearer.
"""


def table(rows):
    lines = ["| scene | points | processor s | standard error | inside | z | in all | "
             "path, s at equal error | times as fast | each point | path, s at equal error | "
             "times as fast |", "|---" * 12 + "|"]
    for r in rows:
        lines.append(
            f"| {r['scene']} | {r['points']} | {r['processor s']} | "
            f"{100 * float(r['standard error']):.2f} % | {100 * float(r['inside']):.0f} % | "
            f"{r['z']} | {100 * float(r['in all']):+.2f} % | {r['path s at equal error']} | "
            f"**{r['times as fast']}** | {100 * float(r['relative error']):.2f} % | "
            f"{r['path s at equal relative error']} | **{r['times as fast by relative error']}** |")
    return "\n".join(lines)


def text(rows, left_out):
    parts = [HEAD, table(rows)]
    if left_out:
        parts.append(f"\nLeft out in this run: {', '.join(left_out)}.")
    return "\n".join(parts) + "\n"
