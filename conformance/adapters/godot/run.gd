# Computes the tangents of all meshes NAME.mesh of a folder, and writes them to NAME.tangents.
# Both are single-precision numbers without a header: position, normal and UV per corner; x, y, z, w per corner.
extends SceneTree

func _init():
	var arguments = OS.get_cmdline_args()
	var folder = arguments[arguments.size() - 1]
	var directory = Directory.new()
	directory.open(folder)
	directory.list_dir_begin(true)
	var name = directory.get_next()
	while name != "":
		if name.ends_with(".mesh"):
			compute(folder + "/" + name)
		name = directory.get_next()
	quit()

func compute(path):
	var file = File.new()
	file.open(path, File.READ)
	var tool_ = SurfaceTool.new()
	tool_.begin(Mesh.PRIMITIVE_TRIANGLES)
	for corner in range(file.get_len() / 32):
		var position = Vector3(file.get_float(), file.get_float(), file.get_float())
		tool_.add_normal(Vector3(file.get_float(), file.get_float(), file.get_float()))
		var u = file.get_float()
		var v = file.get_float()
		tool_.add_uv(Vector2(u, v))
		tool_.add_vertex(position)
	file.close()
	tool_.generate_tangents()
	var tangents = tool_.commit_to_arrays()[Mesh.ARRAY_TANGENT]
	file.open(path.get_basename() + ".tangents", File.WRITE)
	for number in tangents:
		file.store_float(number)
	file.close()
