document.title = "Wunderlich";
